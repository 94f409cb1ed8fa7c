#include "scene/read_media.h"

#include "scene/read_phase.h"
#include "scene/read_volumes.h"

namespace parhelion {
namespace {

/// Reads extinction and albedo from sigma_s and sigma_a, if those are given.
bool readScatteringAndAbsorption(PropertyReader& reader, MediumDescription& medium) {
    if (!reader.has("sigma_s") && !reader.has("sigma_a")) return false;
    for (const char* name : {"sigma_t", "albedo"})
        if (reader.has(name))
            reader.fail(reader.whereOf(name), fmt::format("give either sigma_t and albedo, or sigma_s and sigma_a; "
                                                          "\"{}\" mixes them",
                                                          name));
    for (const char* name : {"sigma_s", "sigma_a"})
        if (!reader.has(name))
            reader.fail(reader.where(), fmt::format("sigma_s and sigma_a go together; needs \"{}\"", name));
    const glm::dvec3 scattering = reader.color("sigma_s", 0.0, kNonNegative);
    medium.sigmaT = scattering + reader.color("sigma_a", 0.0, kNonNegative);
    for (int channel = 0; channel < 3; ++channel)
        medium.albedo[channel] = medium.sigmaT[channel] > 0.0 ? scattering[channel] / medium.sigmaT[channel] : 0.0;
    return true;
}

void readExtinction(ReadContext& context, PropertyReader& reader, MediumDescription& medium) {
    const bool heterogeneous = reader.type() == "heterogeneous";
    const auto volume = reader.namedNested("sigma_t", "volume");
    if (!volume) {
        medium.sigmaT = reader.color("sigma_t", 1.0, kNonNegative);
        if (heterogeneous) medium.extent = {glm::dmat4(1.0), medium.where};
        return;
    }
    ReadVolume read = readVolumePlugin(context, *volume->element, VolumeRole::Extinction);
    if (read.grid && !heterogeneous)
        reader.fail(volume->where, "\"sigma_t\" cannot be a grid; use type \"heterogeneous\"");
    if (!heterogeneous && read.extent.toWorld != glm::dmat4(1.0))
        context.note(volume->where, "\"to_world\" has no effect: a homogeneous medium fills its boundary");
    medium.sigmaT = read.constant;
    if (heterogeneous && !read.grid) medium.extent = std::move(read.extent);
    medium.density = std::move(read.grid);
}

void readAlbedo(ReadContext& context, PropertyReader& reader, MediumDescription& medium) {
    const auto volume = reader.namedNested("albedo", "volume");
    if (!volume) {
        medium.albedo = reader.color("albedo", 0.75, kUnitInterval);
        return;
    }
    ReadVolume read = readVolumePlugin(context, *volume->element, VolumeRole::Albedo);
    medium.albedo = read.constant;
    medium.albedoGrid = std::move(read.grid);
}

}  // namespace

MediumDescription readMedium(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    if (reader.type() != "homogeneous" && reader.type() != "heterogeneous")
        reader.rejectType({"homogeneous", "heterogeneous"});
    MediumDescription medium;
    medium.id = reader.id();
    medium.where = reader.where();
    if (reader.type() == "heterogeneous" || !readScatteringAndAbsorption(reader, medium)) {
        readExtinction(context, reader, medium);
        readAlbedo(context, reader, medium);
    }
    medium.sigmaT *= reader.number("scale", 1.0, kNonNegative);
    if (const auto phase = reader.onlyNested("phase")) medium.phase = readPhase(context, *phase->element);
    for (const char* name : {"sample_emitters", "has_spectral_extinction"})
        if (reader.has(name)) {
            reader.boolean(name, true);
            context.note(reader.whereOf(name),
                         fmt::format("\"{}\" has no effect: it only steers Mitsuba's sampling", name));
        }
    reader.finish();
    return medium;
}

std::size_t mediumIndex(ReadContext& context, const XmlElement& element) {
    if (const auto known = context.mediumIndices.find(&element); known != context.mediumIndices.end())
        return known->second;
    context.scene.media.push_back(readMedium(context, element));
    return context.mediumIndices[&element] = context.scene.media.size() - 1;
}

}  // namespace parhelion
