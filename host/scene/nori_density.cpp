#include "scene/nori_density.h"

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>

#include "volume/volume_file.h"

namespace parhelion {
namespace {

constexpr std::array kCloudProperties{"detailAmount", "noiseScale", "warpAmount",       "erosionAmount",
                                      "surfaceWidth", "noiseSeed",  "densityThreshold", "bakeResolution"};

bool isCloud(const PropertyReader& reader) {
    return std::ranges::any_of(kCloudProperties, [&reader](const char* name) { return reader.has(name); });
}

/// Values not given are those of the baseline's sweep.
shared::CloudField readCloud(PropertyReader& reader) {
    const auto read = [&reader](const char* name, double fallback, const NumberRange& range) {
        return static_cast<float>(reader.number(name, fallback, range));
    };
    shared::CloudField cloud{};
    cloud.detailAmount = read("detailAmount", 0.0, kNonNegative);
    cloud.noiseScale = read("noiseScale", 2.6, kNonNegative);
    cloud.warpAmount = read("warpAmount", 0.28, kNonNegative);
    cloud.erosionAmount = read("erosionAmount", 0.3, kNonNegative);
    cloud.surfaceWidth = read("surfaceWidth", 0.14, kNonNegative);
    cloud.densityScale = read("densityScale", 0.85, kNonNegative);
    cloud.densityThreshold = read("densityThreshold", 0.02, kUnitInterval);
    cloud.noiseSeed = static_cast<std::uint32_t>(reader.integer("noiseSeed", 4, 0, 0xffffffffLL));
    constexpr std::int64_t kFinest = 1024;  // 4 GiB of voxels
    cloud.resolution = glm::uvec3(static_cast<unsigned>(reader.integer("bakeResolution", 128, 2, kFinest)));
    return cloud;
}

Volume readFile(ReadContext& context, PropertyReader& reader, const char* name) {
    VolumeReadOptions options;
    options.memoryLimitBytes = context.options.volumeMemoryLimitBytes;
    if (const XmlAttribute* grid = reader.text("gridName")) options.gridName = grid->value;
    const std::filesystem::path file = reader.file(name);
    Volume volume = readVolume(file, reader.whereOf(name), options);
    if (volume.channels != 1)
        reader.fail(reader.whereOf(name), fmt::format("the density must be a grid of one channel; {} has {}",
                                                      volume.source, volume.channels));
    if (!volume.note.empty()) context.note(reader.whereOf(name), volume.note);
    return volume;
}

}  // namespace

glm::dmat4 readNoriBounds(PropertyReader& reader, const std::optional<std::pair<glm::dvec3, glm::dvec3>>& fallback) {
    for (const char* name : {"boundsMin", "boundsMax"})
        if (!reader.has(name) && (!fallback || reader.has("boundsMin") || reader.has("boundsMax")))
            reader.fail(reader.where(), fmt::format("needs <point name=\"{}\">: boundsMin and boundsMax say which box "
                                                    "the medium fills",
                                                    name));
    const auto [low, high] = fallback.value_or(std::pair(glm::dvec3(0.0), glm::dvec3(1.0)));
    const glm::dvec3 least = reader.triple("boundsMin", low), most = reader.triple("boundsMax", high);
    const glm::dvec3 extent = most - least;
    if (!(extent.x > 0.0 && extent.y > 0.0 && extent.z > 0.0 && glm::length(extent) < 1e30))
        reader.fail(reader.whereOf("boundsMax"), "\"boundsMax\" must lie above \"boundsMin\" on every axis");
    return reader.transform("toWorld").matrix * glm::scale(glm::translate(glm::dmat4(1.0), least), extent);
}

GridPlacement readNoriDensity(ReadContext& context, PropertyReader& reader, glm::dvec3& sigmaT) {
    GridPlacement placement;
    placement.where = reader.where();
    const char* file = reader.has("density") ? "density" : "filename";
    std::pair<glm::dvec3, glm::dvec3> bounds{glm::dvec3(0.0), glm::dvec3(1.0)};
    if (reader.has(file)) {
        placement.volume = readFile(context, reader, file);
        bounds = {placement.volume.boundsMin, placement.volume.boundsMax};
    }
    if (isCloud(reader)) {
        placement.cloud = readCloud(reader);
        placement.cloud->modulates = reader.has(file) ? 1u : 0u;
    } else if (reader.has(file)) {
        sigmaT *= reader.number("densityScale", 1.0, kNonNegative);
    } else {
        reader.fail(reader.where(),
                    "needs a density: \"filename\" of a volume, or a procedural cloud's \"detailAmount\"");
    }
    placement.toWorld = readNoriBounds(reader, bounds);
    return placement;
}

}  // namespace parhelion
