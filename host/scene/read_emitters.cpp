#include "scene/read_emitters.h"

namespace parhelion {
namespace {

const std::vector<std::string> kSceneEmitters{"constant", "directional", "point"};

/// Accepts Mitsuba's weight for choosing lights. Light selection here follows from power alone.
void readSamplingWeight(ReadContext& context, PropertyReader& reader) {
    const double weight = reader.number("sampling_weight", 1.0, kNonNegative);
    if (weight != 1.0)
        context.note(reader.whereOf("sampling_weight"),
                     "\"sampling_weight\" has no effect on the image; lights are chosen by our own rule");
}

void requireOneForm(const PropertyReader& reader, const char* property) {
    if (reader.has(property) && reader.has("to_world"))
        reader.fail(reader.whereOf("to_world"), fmt::format("give either \"{}\" or \"to_world\", not both", property));
}

void readDirectional(PropertyReader& reader, EmitterDescription& emitter) {
    emitter.type = EmitterDescription::Type::Directional;
    emitter.value = reader.color("irradiance", 1.0, kNonNegative);
    requireOneForm(reader, "direction");
    const glm::dmat4 toWorld = reader.transform("to_world").matrix;
    const glm::dvec3 direction = reader.triple("direction", glm::dvec3(toWorld[2]));
    const double length = glm::length(direction);
    if (!(length > 0.0 && length < 1e150))
        reader.fail(reader.whereOf("direction"), "\"direction\" must not be zero or longer than 1e150");
    emitter.vector = direction / length;
}

void readPoint(PropertyReader& reader, EmitterDescription& emitter) {
    emitter.type = EmitterDescription::Type::Point;
    emitter.value = reader.color("intensity", 1.0, kNonNegative);
    requireOneForm(reader, "position");
    const glm::dmat4 toWorld = reader.transform("to_world").matrix;
    emitter.vector = reader.triple("position", glm::dvec3(toWorld[3]));
}

void readConstant(const ReadContext& context, PropertyReader& reader, EmitterDescription& emitter) {
    emitter.type = EmitterDescription::Type::Constant;
    emitter.value = reader.color("radiance", 1.0, kNonNegative);
    for (const EmitterDescription& other : context.scene.emitters)
        if (other.type == EmitterDescription::Type::Constant)
            reader.fail(reader.where(),
                        fmt::format("only one emitter may surround the scene; the first is at {}", other.where.text()));
}

}  // namespace

void readEmitter(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    EmitterDescription emitter;
    emitter.where = reader.where();
    if (reader.type() == "constant")
        readConstant(context, reader, emitter);
    else if (reader.type() == "directional")
        readDirectional(reader, emitter);
    else if (reader.type() == "point")
        readPoint(reader, emitter);
    else if (reader.type() == "area")
        reader.fail(reader.where(), "must be nested in a <shape>");
    else
        reader.rejectType(kSceneEmitters);
    readSamplingWeight(context, reader);
    reader.finish();
    context.scene.emitters.push_back(std::move(emitter));
}

void readAreaEmitter(ReadContext& context, const XmlElement& element, ShapeDescription& shape) {
    PropertyReader reader(context.tree, element);
    if (reader.type() != "area") reader.rejectType({"area"});
    shape.radiance = reader.color("radiance", 1.0, kNonNegative);
    shape.emitsOnBothSides = reader.boolean("two_sided", false);
    readSamplingWeight(context, reader);
    reader.finish();
}

}  // namespace parhelion
