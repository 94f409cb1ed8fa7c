#include "scene/read_cloud.h"

#include <algorithm>
#include <cmath>

#include "scene/read_volumes.h"

namespace parhelion {
namespace {

constexpr std::int64_t kMaxBakeResolution = 1024;
constexpr NumberRange kUpToFour{0.0, 4.0, false, false, "be in [0, 4]"};

constexpr CloudNames kNames{.detailAmount = "detail_amount",
                            .noiseScale = "noise_scale",
                            .warpAmount = "warp_amount",
                            .erosionAmount = "erosion_amount",
                            .surfaceWidth = "surface_width",
                            .noiseSeed = "noise_seed",
                            .densityScale = "density_scale",
                            .densityThreshold = "density_threshold",
                            .bakeResolution = "bake_resolution"};

/// The noise's parameters; defaults are those of the sweep of clouds that the formula comes from.
shared::CloudField readNoise(PropertyReader& reader, const CloudNames& names) {
    constexpr NumberRange kScale{0.0, 256.0, true, false, "be in (0, 256]"};
    constexpr NumberRange kWidth{1e-3, 4.0, false, false, "be in [0.001, 4]"};
    shared::CloudField field{};
    field.detailAmount = float(reader.number(names.detailAmount, 0.62, kUpToFour));
    field.noiseScale = float(reader.number(names.noiseScale, 2.6, kScale));
    field.warpAmount = float(reader.number(names.warpAmount, 0.28, kUpToFour));
    field.erosionAmount = float(reader.number(names.erosionAmount, 0.30, kUpToFour));
    field.surfaceWidth = float(reader.number(names.surfaceWidth, 0.14, kWidth));
    field.noiseSeed = std::uint32_t(reader.integer(names.noiseSeed, 4, 0, 0xffffffff));
    return field;
}

/// `longest` voxels along the longest axis of `shape`, the others in proportion.
glm::uvec3 proportional(glm::uvec3 shape, std::int64_t longest) {
    const double scale = double(longest) / std::max({shape.x, shape.y, shape.z});
    return glm::uvec3(glm::max(glm::round(glm::dvec3(shape) * scale), glm::dvec3(1.0)));
}

void readModulation(ReadContext& context, PropertyReader& reader, const PropertyReader::Nested& nested,
                    GridPlacement& placement) {
    for (const char* name : {"density_scale", "to_world"})
        if (reader.has(name))
            reader.fail(reader.whereOf(name),
                        fmt::format("\"{}\" does not go with a density to modulate: its mass is kept, and it is placed "
                                    "where that density is",
                                    name));
    if (nested.element->require("type").value != "gridvolume")
        reader.fail(nested.where, "the density to modulate must be a gridvolume");
    ReadVolume base = readVolumePlugin(context, *nested.element, VolumeRole::Extinction);
    if (base.grid->volume.channels != 1)
        reader.fail(nested.where, fmt::format("the density to modulate must be a grid of one channel; {} has {}",
                                              base.grid->volume.source, base.grid->volume.channels));
    placement.cloud = readCloudModulation(reader, kNames, base.grid->volume.density.resolution());
    placement.volume = std::move(base.grid->volume);
    placement.toWorld = base.grid->toWorld;
}

}  // namespace

shared::CloudField readCloud(PropertyReader& reader, const CloudNames& names) {
    constexpr NumberRange kDensityScale{0.0, 1000.0, false, false, "be in [0, 1000]"};
    shared::CloudField field = readNoise(reader, names);
    field.densityScale = float(reader.number(names.densityScale, 0.85, kDensityScale));
    field.densityThreshold = float(reader.number(names.densityThreshold, 0.02, kUnitInterval));
    field.resolution = glm::uvec3(std::uint32_t(reader.integer(names.bakeResolution, 128, 1, kMaxBakeResolution)));
    return field;
}

shared::CloudField readCloudModulation(PropertyReader& reader, const CloudNames& names, glm::uvec3 resolution) {
    shared::CloudField field = readNoise(reader, names);
    field.modulates = 1;
    field.densityScale = 1;
    field.densityThreshold = float(reader.number(names.densityThreshold, 0.0, kNonNegative));
    field.resolution = resolution;
    if (reader.has(names.bakeResolution))
        field.resolution = proportional(resolution, reader.integer(names.bakeResolution, 128, 1, kMaxBakeResolution));
    return field;
}

GridPlacement readProceduralCloud(ReadContext& context, PropertyReader& reader) {
    GridPlacement placement;
    placement.where = reader.where();
    if (const auto nested = reader.onlyNested("volume")) {
        readModulation(context, reader, *nested, placement);
    } else {
        placement.cloud = readCloud(reader, kNames);
        placement.toWorld = reader.transform("to_world").matrix;
    }
    reader.finish();
    placement.volume.source = "procedural cloud";
    return placement;
}

}  // namespace parhelion
