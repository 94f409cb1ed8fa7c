#include "scene/read_phase.h"

#include <algorithm>

#include "scene/attribute_values.h"

namespace parhelion {
namespace {

using Type = PhaseDescription::Type;

constexpr NumberRange kCosine{-1.0, 1.0, true, true, "be in (-1, 1)"};

double requiredNumber(PropertyReader& reader, const char* name, const NumberRange& range) {
    if (!reader.has(name)) reader.fail(reader.where(), fmt::format("needs <float name=\"{}\">", name));
    return reader.number(name, 0.0, range);
}

void readDualLobes(PropertyReader& reader, PhaseDescription& phase) {
    phase.type = Type::DualHenyeyGreenstein;
    phase.g = requiredNumber(reader, "g1", kCosine);
    phase.g2 = requiredNumber(reader, "g2", kCosine);
    phase.lobeWeight = requiredNumber(reader, "weight", kUnitInterval);
}

/// The weight of a blend: a number, or the constant volume that Mitsuba makes of one.
double readBlendWeight(const ReadContext& context, PropertyReader& reader) {
    const auto volume = reader.namedNested("weight", "volume");
    if (!volume) return requiredNumber(reader, "weight", kUnitInterval);
    PropertyReader constant(context.tree, *volume->element);
    if (constant.type() != "constvolume")
        reader.fail(volume->where,
                    "\"weight\" cannot vary in space here; it takes a number or a <volume "
                    "type=\"constvolume\"> of one");
    constant.transform("to_world");  // Mitsuba looks the weight up without asking where
    const glm::dvec3 weight = constant.color("value", 1.0, kUnitInterval);
    if (weight != glm::dvec3(weight.x))
        reader.fail(constant.whereOf("value"), "\"weight\" cannot differ between channels");
    constant.finish();
    return weight.x;
}

/// Mitsuba's weight is that of the second function.
void readBlend(const ReadContext& context, PropertyReader& reader, PhaseDescription& phase) {
    const auto nested = reader.nested("phase");
    if (nested.size() != 2)
        reader.fail(reader.where(), fmt::format("blends two <phase>, nested in it; got {}", nested.size()));
    double g[2];
    for (std::size_t i = 0; i < 2; ++i) {
        const std::string& type = nested[i].element->require("type").value;
        if (type != "isotropic" && type != "hg")
            reader.fail(nested[i].where, "only phase functions of type isotropic or hg can be blended");
        g[i] = readPhase(context, *nested[i].element).g;
    }
    phase.type = Type::DualHenyeyGreenstein;
    phase.g = g[0];
    phase.g2 = g[1];
    phase.lobeWeight = 1.0 - readBlendWeight(context, reader);
}

void readTable(PropertyReader& reader, PhaseDescription& phase) {
    const XmlAttribute* values = reader.text("values");
    if (!values) reader.fail(reader.where(), "needs <string name=\"values\">");
    const auto require = [&](bool holds, const std::string& what) {
        if (!holds) reader.fail(values->where, fmt::format("\"values\" must {}", what));
    };
    phase.type = Type::Tabulated;
    phase.table = parseNumbers(*values);
    require(phase.table.size() >= 2 && phase.table.size() <= PhaseDescription::kMostTableValues,
            fmt::format("hold 2 to {} numbers; got {}", PhaseDescription::kMostTableValues, phase.table.size()));
    const auto negative = std::ranges::find_if(phase.table, [](double value) { return value < 0.0; });
    if (negative != phase.table.end())
        require(false, fmt::format("be >= 0; got {} as number {}", *negative, negative - phase.table.begin() + 1));
    require(std::ranges::any_of(phase.table, [](double value) { return value > 0.0; }), "not be zero everywhere");
}

}  // namespace

PhaseDescription readPhase(const ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    PhaseDescription phase;
    phase.where = reader.where();
    if (reader.type() == "hg") {
        phase.type = Type::HenyeyGreenstein;
        phase.g = reader.number("g", 0.8, kCosine);
    } else if (reader.type() == "dual_hg") {
        readDualLobes(reader, phase);
    } else if (reader.type() == "blendphase") {
        readBlend(context, reader, phase);
    } else if (reader.type() == "rayleigh") {
        phase.type = Type::Rayleigh;
    } else if (reader.type() == "tabphase") {
        readTable(reader, phase);
    } else if (reader.type() != "isotropic") {
        reader.rejectType({"isotropic", "hg", "dual_hg", "blendphase", "rayleigh", "tabphase"});
    }
    reader.finish();
    return phase;
}

}  // namespace parhelion
