#include "scene/nori_density.h"

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/read_cloud.h"
#include "volume/volume_file.h"

namespace parhelion {
namespace {

constexpr CloudNames kNames{.detailAmount = "detailAmount",
                            .noiseScale = "noiseScale",
                            .warpAmount = "warpAmount",
                            .erosionAmount = "erosionAmount",
                            .surfaceWidth = "surfaceWidth",
                            .noiseSeed = "noiseSeed",
                            .densityScale = "densityScale",
                            .densityThreshold = "densityThreshold",
                            .bakeResolution = "bakeResolution"};

/// Whether a property was given that only a cloud has; a density from a file has a scale, too.
bool isCloud(PropertyReader& reader) {
    constexpr std::array kOfCloudsAlone{kNames.detailAmount,     kNames.noiseScale,    kNames.warpAmount,
                                        kNames.erosionAmount,    kNames.surfaceWidth,  kNames.noiseSeed,
                                        kNames.densityThreshold, kNames.bakeResolution};
    return std::ranges::any_of(kOfCloudsAlone, [&reader](const char* name) { return reader.has(name); });
}

Volume readFile(ReadContext& context, PropertyReader& reader, const char* name) {
    VolumeReadOptions options;
    options.memoryLimitBytes = context.options.volumeMemoryLimitBytes;
    if (const XmlAttribute* grid = reader.text("gridName")) options.gridName = grid->value;
    options.gridNameWhere = reader.whereOf("gridName");
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
        sigmaT *= reader.number("densityScale", 1.0, kNonNegative);
        if (isCloud(reader))
            placement.cloud = readCloudModulation(reader, kNames, placement.volume.density.resolution());
    } else if (isCloud(reader)) {
        placement.cloud = readCloud(reader, kNames);
        placement.volume.source = "procedural cloud";
    } else {
        reader.fail(reader.where(),
                    "needs a density: \"filename\" of a volume, or a procedural cloud's \"detailAmount\"");
    }
    placement.toWorld = readNoriBounds(reader, bounds);
    return placement;
}

}  // namespace parhelion
