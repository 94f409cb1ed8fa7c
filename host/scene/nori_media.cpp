#include "scene/nori_media.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/nori_density.h"

namespace parhelion {
namespace {

constexpr NumberRange kCosine{-1.0, 1.0, true, true, "be in (-1, 1)"};

double requiredNumber(PropertyReader& reader, const char* name, const NumberRange& range) {
    if (!reader.has(name)) reader.fail(reader.where(), fmt::format("needs <float name=\"{}\">", name));
    return reader.number(name, 0.0, range);
}

PhaseDescription readPhase(const ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    PhaseDescription phase;
    phase.where = reader.where();
    if (reader.type() == "hg") {
        phase.type = PhaseDescription::Type::HenyeyGreenstein;
        phase.g = requiredNumber(reader, "g", kCosine);
    } else if (reader.type() == "dual_hg") {
        phase.type = PhaseDescription::Type::DualHenyeyGreenstein;
        phase.g = requiredNumber(reader, "g1", kCosine);
        phase.g2 = requiredNumber(reader, "g2", kCosine);
        phase.lobeWeight = requiredNumber(reader, "weight", kUnitInterval);
    } else if (reader.type() != "isotropic") {
        reader.rejectType({"isotropic", "hg", "dual_hg"});
    }
    reader.finish();
    return phase;
}

/// A total that is given beside its parts must be their sum.
void checkTotal(PropertyReader& reader, const glm::dvec3& sum) {
    if (!reader.has("sigmaT")) return;
    constexpr double kTolerance = 1e-6;  // six written digits
    const glm::dvec3 total = reader.color("sigmaT", 0.0, kNonNegative);
    for (int channel = 0; channel < 3; ++channel)
        if (std::abs(total[channel] - sum[channel]) > kTolerance * sum[channel])
            reader.fail(reader.whereOf("sigmaT"), fmt::format("\"sigmaT\" must be sigmaA + sigmaS, which is {}; got {}",
                                                              sum[channel], total[channel]));
}

void readCoefficients(PropertyReader& reader, MediumDescription& medium) {
    if (reader.has("albedo")) {
        for (const char* name : {"sigmaA", "sigmaS"})
            if (reader.has(name))
                reader.fail(
                    reader.whereOf(name),
                    fmt::format("give either sigmaT and albedo, or sigmaA and sigmaS; \"{}\" mixes them", name));
        if (!reader.has("sigmaT")) reader.fail(reader.where(), "sigmaT and albedo go together; needs \"sigmaT\"");
        medium.albedo = reader.color("albedo", 0.0, kUnitInterval);
        medium.sigmaT = reader.color("sigmaT", 0.0, kNonNegative);
        return;
    }
    for (const char* name : {"sigmaA", "sigmaS"})
        if (!reader.has(name))
            reader.fail(reader.where(),
                        fmt::format("needs sigmaA and sigmaS, or sigmaT and albedo; \"{}\" is missing", name));
    const glm::dvec3 scattering = reader.color("sigmaS", 0.0, kNonNegative);
    medium.sigmaT = scattering + reader.color("sigmaA", 0.0, kNonNegative);
    checkTotal(reader, medium.sigmaT);
    for (int channel = 0; channel < 3; ++channel)
        medium.albedo[channel] = medium.sigmaT[channel] > 0.0 ? scattering[channel] / medium.sigmaT[channel] : 0.0;
}

struct PlacedMedium {
    std::size_t index;
    std::optional<glm::dmat4> bounds;  ///< unit cube -> world
};

/// @param needsBounds  whether a homogeneous medium must say where it is.
PlacedMedium readMedium(ReadContext& context, const XmlElement& element, bool needsBounds) {
    PropertyReader reader(context.tree, element);
    MediumDescription medium;
    medium.where = reader.where();
    readCoefficients(reader, medium);
    medium.sigmaT *= reader.number("scale", 1.0, kNonNegative);
    if (reader.has("majorant")) {
        reader.number("majorant", 0.0, kNonNegative);
        context.note(reader.whereOf("majorant"), "\"majorant\" has no effect: bounds are computed from the density");
    }
    if (const auto phase = reader.onlyNested("phase")) medium.phase = readPhase(context, *phase->element);

    std::optional<glm::dmat4> bounds;
    if (reader.type() == "heterogeneous") {
        medium.density = readNoriDensity(context, reader, medium.sigmaT);
        bounds = medium.density->toWorld;
    } else if (reader.type() == "homogeneous") {
        if (needsBounds) bounds = readNoriBounds(reader, std::nullopt);
    } else {
        reader.rejectType({"homogeneous", "heterogeneous"});
    }
    reader.finish();
    context.scene.media.push_back(std::move(medium));
    return {context.scene.media.size() - 1, bounds};
}

}  // namespace

std::size_t readNoriMedium(ReadContext& context, const XmlElement& element) {
    return readMedium(context, element, /*needsBounds*/ false).index;
}

void readNoriMediumInItsBounds(ReadContext& context, const XmlElement& element) {
    const PlacedMedium medium = readMedium(context, element, /*needsBounds*/ true);
    ShapeDescription shape;
    shape.type = ShapeDescription::Type::Cube;
    shape.where = shape.bsdf.where = element.where;
    shape.bsdf.type = BsdfDescription::Type::Null;
    shape.interior = medium.index;
    // The cube is [-1, 1]^3.
    shape.toWorld = glm::scale(glm::translate(*medium.bounds, glm::dvec3(0.5)), glm::dvec3(0.5));
    context.scene.shapes.push_back(std::move(shape));
}

}  // namespace parhelion
