#include "scene/nori_density.h"

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>

#include "volume/volume_file.h"

namespace parhelion {
namespace {

constexpr std::array kCloudProperties{"detailAmount", "noiseScale", "warpAmount",       "erosionAmount",
                                      "surfaceWidth", "noiseSeed",  "densityThreshold", "bakeResolution"};

bool isCloud(PropertyReader& reader) {
    return std::ranges::any_of(kCloudProperties, [&reader](const char* name) { return reader.has(name); });
}

constexpr std::int64_t kMaxBakeResolution = 1024;
constexpr NumberRange kUpToFour{0.0, 4.0, false, false, "be in [0, 4]"};

/// The noise's parameters; values not given are those of the baseline's sweep.
shared::CloudField readNoise(PropertyReader& reader) {
    constexpr NumberRange kScale{0.0, 256.0, true, false, "be in (0, 256]"};
    constexpr NumberRange kWidth{1e-3, 4.0, false, false, "be in [0.001, 4]"};
    shared::CloudField cloud{};
    cloud.detailAmount = float(reader.number("detailAmount", 0.62, kUpToFour));
    cloud.noiseScale = float(reader.number("noiseScale", 2.6, kScale));
    cloud.warpAmount = float(reader.number("warpAmount", 0.28, kUpToFour));
    cloud.erosionAmount = float(reader.number("erosionAmount", 0.3, kUpToFour));
    cloud.surfaceWidth = float(reader.number("surfaceWidth", 0.14, kWidth));
    cloud.noiseSeed = std::uint32_t(reader.integer("noiseSeed", 4, 0, 0xffffffffLL));
    return cloud;
}

shared::CloudField readCloud(PropertyReader& reader) {
    constexpr NumberRange kDensityScale{0.0, 1000.0, false, false, "be in [0, 1000]"};
    shared::CloudField cloud = readNoise(reader);
    cloud.densityScale = float(reader.number("densityScale", 0.85, kDensityScale));
    cloud.densityThreshold = float(reader.number("densityThreshold", 0.02, kUnitInterval));
    cloud.resolution = glm::uvec3(unsigned(reader.integer("bakeResolution", 128, 1, kMaxBakeResolution)));
    return cloud;
}

/// The detail that erodes a file's density, at its resolution unless told how many voxels its longest axis has.
shared::CloudField readModulation(PropertyReader& reader, const glm::uvec3& resolution) {
    shared::CloudField cloud = readNoise(reader);
    cloud.modulates = 1;
    cloud.densityScale = 1.0f;
    cloud.densityThreshold = float(reader.number("densityThreshold", 0.0, kNonNegative));
    cloud.resolution = resolution;
    if (!reader.has("bakeResolution")) return cloud;
    const double longest = double(reader.integer("bakeResolution", 128, 1, kMaxBakeResolution));
    const glm::dvec3 shape(resolution);
    cloud.resolution = glm::max(glm::round(shape * (longest / std::max({shape.x, shape.y, shape.z}))), glm::dvec3(1.0));
    return cloud;
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
        if (isCloud(reader)) placement.cloud = readModulation(reader, placement.volume.density.resolution());
    } else if (isCloud(reader)) {
        placement.cloud = readCloud(reader);
        placement.volume.source = "procedural cloud";
    } else {
        reader.fail(reader.where(),
                    "needs a density: \"filename\" of a volume, or a procedural cloud's \"detailAmount\"");
    }
    placement.toWorld = readNoriBounds(reader, bounds);
    return placement;
}

}  // namespace parhelion
