#include "scene/read_cloud.h"

#include <algorithm>
#include <cmath>

#include "scene/read_volumes.h"

namespace parhelion {
namespace {

constexpr std::int64_t kMaxBakeResolution = 1024;
constexpr NumberRange kUpToFour{0.0, 4.0, false, false, "be in [0, 4]"};

/// The noise's parameters; defaults are those of the sweep of clouds that the formula comes from.
shared::CloudField readNoise(PropertyReader& reader) {
    constexpr NumberRange kScale{0.0, 256.0, true, false, "be in (0, 256]"};
    constexpr NumberRange kWidth{1e-3, 4.0, false, false, "be in [0.001, 4]"};
    shared::CloudField field{};
    field.detailAmount = float(reader.number("detail_amount", 0.62, kUpToFour));
    field.noiseScale = float(reader.number("noise_scale", 2.6, kScale));
    field.warpAmount = float(reader.number("warp_amount", 0.28, kUpToFour));
    field.erosionAmount = float(reader.number("erosion_amount", 0.30, kUpToFour));
    field.surfaceWidth = float(reader.number("surface_width", 0.14, kWidth));
    field.noiseSeed = std::uint32_t(reader.integer("noise_seed", 4, 0, 0xffffffff));
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
    shared::CloudField& field = *placement.cloud;
    const glm::uvec3 n = base.grid->volume.density.resolution();
    const std::int64_t longest = std::max({n.x, n.y, n.z});
    field.modulates = 1;
    field.densityScale = 1;
    field.densityThreshold = float(reader.number("density_threshold", 0.0, kNonNegative));
    field.resolution = n;
    if (reader.has("bake_resolution"))
        field.resolution = proportional(n, reader.integer("bake_resolution", longest, 1, kMaxBakeResolution));
    placement.volume = std::move(base.grid->volume);
    placement.toWorld = base.grid->toWorld;
}

}  // namespace

GridPlacement readProceduralCloud(ReadContext& context, PropertyReader& reader) {
    constexpr NumberRange kDensityScale{0.0, 1000.0, false, false, "be in [0, 1000]"};
    GridPlacement placement;
    placement.where = reader.where();
    placement.cloud = readNoise(reader);
    if (const auto nested = reader.onlyNested("volume")) {
        readModulation(context, reader, *nested, placement);
    } else {
        shared::CloudField& field = *placement.cloud;
        field.densityScale = float(reader.number("density_scale", 0.85, kDensityScale));
        field.densityThreshold = float(reader.number("density_threshold", 0.02, kUnitInterval));
        field.resolution = glm::uvec3(std::uint32_t(reader.integer("bake_resolution", 128, 1, kMaxBakeResolution)));
        placement.toWorld = reader.transform("to_world").matrix;
    }
    reader.finish();
    placement.volume.source = "procedural cloud";
    return placement;
}

}  // namespace parhelion
