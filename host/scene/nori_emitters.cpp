#include "scene/nori_emitters.h"

#include <algorithm>
#include <numbers>

#include "scene/read_bitmaps.h"
#include "scene/read_sky.h"
#include "scene/transforms.h"

namespace parhelion {
namespace {

using Type = EmitterDescription::Type;

bool surrounds(const EmitterDescription& emitter) {
    return emitter.type != Type::Directional && emitter.type != Type::Point;
}

/// The one of two names that was given; the first when neither was.
const char* givenName(PropertyReader& reader, const char* name, const char* alias) {
    if (!reader.has(alias)) return name;
    if (reader.has(name))
        reader.fail(reader.whereOf(alias), fmt::format("give either \"{}\" or \"{}\", not both", name, alias));
    return alias;
}

void readDirectional(PropertyReader& reader, EmitterDescription& emitter) {
    emitter.type = Type::Directional;
    emitter.value = reader.color(givenName(reader, "radiance", "irradiance"), 1.0, kNonNegative);
    const glm::dvec3 direction = reader.triple("direction", {0.0, 0.0, 1.0});
    const double length = glm::length(direction);
    if (!(length > 1e-150 && length < 1e150))
        reader.fail(reader.whereOf("direction"), "\"direction\" must not be zero or longer than 1e150");
    emitter.vector = direction / length;
}

/// `power` is the light's flux, as in Nori's exercises.
void readPoint(PropertyReader& reader, EmitterDescription& emitter) {
    emitter.type = Type::Point;
    const std::string name = givenName(reader, "power", "intensity");
    emitter.value = reader.color(name, 1.0, kNonNegative);
    if (name == "power") emitter.value /= 4.0 * std::numbers::pi;
    emitter.vector = reader.triple("position", glm::dvec3(0.0));
}

/// The map's orientation is the baseline's: Mitsuba's, turned by -90 degrees about +y.
void readMap(ReadContext& context, PropertyReader& reader, EmitterDescription& emitter) {
    emitter.type = Type::EnvironmentMap;
    emitter.value = reader.color("scale", 1.0, kNonNegative);
    emitter.toWorld = reader.transform("toWorld").matrix * rotationMatrix({0.0, 1.0, 0.0}, -90.0);
    constexpr double kTolerance = 1e-4;
    const Similarity similarity = similarityOf(emitter.toWorld);
    if (!similarity.holds || std::abs(similarity.scale - 1.0) > kTolerance)
        reader.fail(reader.whereOf("toWorld"), "\"toWorld\" of an environment map must not scale or shear");
    if (glm::dvec3(emitter.toWorld[3]) != glm::dvec3(0.0))
        context.note(reader.whereOf("toWorld"),
                     "the translation of an environment map, infinitely far away, has no effect");
    const std::filesystem::path file = reader.file("filename");
    emitter.map = readEnvironmentBitmap(context, file, reader.whereOf("filename"));
}

void readInfinite(PropertyReader& reader, EmitterDescription& emitter) {
    emitter.type = Type::Sky;
    const SkyNames names{.axis = "axis",
                         .offset = "offset",
                         .width = "width",
                         .power = "power",
                         .bottom = givenName(reader, "bottom", "bottomColor"),
                         .top = givenName(reader, "top", "topColor"),
                         .starDensity = "starDensity",
                         .starSize = "starSize",
                         .starRadiance = "starBrightness",
                         .starSeed = "starSeed"};
    emitter.sky = readSky(reader, names, ColorRole::Value);
}

}  // namespace

void readNoriEmitter(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    EmitterDescription emitter;
    emitter.where = reader.where();
    if (reader.type() == "envmap") {
        readMap(context, reader, emitter);
    } else if (reader.type() == "infinite") {
        readInfinite(reader, emitter);
    } else if (reader.type() == "constant") {
        emitter.value = reader.color("radiance", 1.0, kNonNegative);
    } else if (reader.type() == "directional") {
        readDirectional(reader, emitter);
    } else if (reader.type() == "point") {
        readPoint(reader, emitter);
    } else if (reader.type() == "area") {
        reader.fail(reader.where(), "must be nested in a <mesh>");
    } else {
        reader.rejectType({"envmap", "infinite", "constant", "directional", "point"});
    }
    reader.finish();
    const auto other = std::ranges::find_if(context.scene.emitters, surrounds);
    if (surrounds(emitter) && other != context.scene.emitters.end())
        reader.fail(reader.where(),
                    fmt::format("only one emitter may surround the scene; the first is at {}", other->where.text()));
    context.scene.emitters.push_back(std::move(emitter));
}

}  // namespace parhelion
