#include "scene/read_emitters.h"

#include <cmath>

#include "scene/read_bitmaps.h"
#include "scene/read_media.h"
#include "scene/read_sky.h"
#include "scene/read_textures.h"
#include "scene/transforms.h"

namespace parhelion {
namespace {

const std::vector<std::string> kSceneEmitters{"constant", "directional", "envmap", "point", "sky"};

/// Accepts Mitsuba's weight for choosing lights. Light selection here follows from power alone.
void readSamplingWeight(ReadContext& context, PropertyReader& reader) {
    const double weight = reader.number("sampling_weight", 1.0, kNonNegative);
    if (weight != 1.0)
        context.note(reader.whereOf("sampling_weight"),
                     "\"sampling_weight\" has no effect on the image; lights are chosen by our own rule");
}

glm::dvec3 readLight(PropertyReader& reader, const char* name) {
    return reader.color(name, 1.0, kNonNegative, ColorRole::Emission);
}

/// Accepts the medium that Mitsuba lets an emitter name, which it makes nothing of.
void readNamedMedium(ReadContext& context, PropertyReader& reader) {
    const auto medium = reader.onlyNested("medium");
    if (!medium) return;
    context.namedMedia.push_back(medium->element);
    context.note(medium->where, "the medium of an emitter has no effect; which one it is in follows from the shapes");
}

void requireOneForm(PropertyReader& reader, const char* property) {
    if (reader.has(property) && reader.has("to_world"))
        reader.fail(reader.whereOf("to_world"), fmt::format("give either \"{}\" or \"to_world\", not both", property));
}

void readDirectional(PropertyReader& reader, EmitterDescription& emitter) {
    emitter.type = EmitterDescription::Type::Directional;
    emitter.value = readLight(reader, "irradiance");
    requireOneForm(reader, "direction");
    const glm::dmat4 toWorld = reader.transform("to_world").matrix;
    const glm::dvec3 direction = reader.triple("direction", glm::dvec3(toWorld[2]));
    const double length = glm::length(direction);
    if (!(length > 1e-150 && length < 1e150))
        reader.fail(reader.whereOf("direction"), "\"direction\" must not be zero or longer than 1e150");
    emitter.vector = direction / length;
}

void readPoint(PropertyReader& reader, EmitterDescription& emitter) {
    emitter.type = EmitterDescription::Type::Point;
    emitter.value = readLight(reader, "intensity");
    requireOneForm(reader, "position");
    const glm::dmat4 toWorld = reader.transform("to_world").matrix;
    emitter.vector = reader.triple("position", glm::dvec3(toWorld[3]));
}

void rejectSecondSurrounding(const ReadContext& context, const PropertyReader& reader) {
    using Type = EmitterDescription::Type;
    for (const EmitterDescription& other : context.scene.emitters)
        if (other.type != Type::Directional && other.type != Type::Point)
            reader.fail(reader.where(),
                        fmt::format("only one emitter may surround the scene; the first is at {}", other.where.text()));
}

void readConstant(ReadContext& context, PropertyReader& reader, EmitterDescription& emitter) {
    rejectSecondSurrounding(context, reader);
    emitter.type = EmitterDescription::Type::Constant;
    emitter.value = readLight(reader, "radiance");
    reader.transform("to_world");
    if (reader.has("to_world"))
        context.note(reader.whereOf("to_world"), "\"to_world\" has no effect: a constant is the same from all sides");
}

void readEnvironmentMap(ReadContext& context, PropertyReader& reader, EmitterDescription& emitter) {
    rejectSecondSurrounding(context, reader);
    emitter.type = EmitterDescription::Type::EnvironmentMap;
    emitter.value = glm::dvec3(reader.number("scale", 1.0, kNonNegative));
    emitter.misCompensation = reader.boolean("mis_compensation", false);
    emitter.toWorld = reader.transform("to_world").matrix;
    const Similarity similarity = similarityOf(emitter.toWorld);
    if (!similarity.holds || std::abs(similarity.scale - 1.0) > 1e-4)
        reader.fail(reader.whereOf("to_world"), "\"to_world\" of an environment map must not scale or shear");
    if (glm::dvec3(emitter.toWorld[3]) != glm::dvec3(0.0))
        context.note(reader.whereOf("to_world"),
                     "the translation of an environment map, infinitely far away, has no effect");
    const std::filesystem::path file = reader.file("filename");
    emitter.map = readEnvironmentBitmap(context, file, reader.whereOf("filename"));
}

constexpr SkyNames kSkyNames{.axis = "axis",
                             .offset = "offset",
                             .width = "width",
                             .power = "power",
                             .bottom = "bottom",
                             .top = "top",
                             .starDensity = "star_density",
                             .starSize = "star_size",
                             .starRadiance = "star_radiance",
                             .starSeed = "star_seed"};

void readSkyEmitter(const ReadContext& context, PropertyReader& reader, EmitterDescription& emitter) {
    rejectSecondSurrounding(context, reader);
    emitter.type = EmitterDescription::Type::Sky;
    emitter.sky = readSky(reader, kSkyNames, ColorRole::Emission);
}

}  // namespace

void readEmitter(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    EmitterDescription emitter;
    emitter.where = reader.where();
    if (reader.type() == "constant")
        readConstant(context, reader, emitter);
    else if (reader.type() == "envmap")
        readEnvironmentMap(context, reader, emitter);
    else if (reader.type() == "sky")
        readSkyEmitter(context, reader, emitter);
    else if (reader.type() == "directional")
        readDirectional(reader, emitter);
    else if (reader.type() == "point")
        readPoint(reader, emitter);
    else if (reader.type() == "area")
        reader.fail(reader.where(), "must be nested in a <shape>");
    else
        reader.rejectType(kSceneEmitters);
    readSamplingWeight(context, reader);
    readNamedMedium(context, reader);
    reader.finish();
    context.scene.emitters.push_back(std::move(emitter));
}

void readAreaEmitter(ReadContext& context, const XmlElement& element, ShapeDescription& shape) {
    PropertyReader reader(context.tree, element);
    if (reader.type() != "area") reader.rejectType({"area"});
    const TexturedColor radiance =
        readTexturedColor(context, reader, "radiance", 1.0, kNonNegative, ColorRole::Emission);
    shape.radiance = radiance.color;
    shape.radianceTexture = radiance.texture;
    shape.emitsOnBothSides = reader.boolean("two_sided", false);
    if (reader.has("to_world"))
        reader.fail(reader.whereOf("to_world"), "an area light is where its shape is; give the shape the \"to_world\"");
    readSamplingWeight(context, reader);
    readNamedMedium(context, reader);
    reader.finish();
}

}  // namespace parhelion
