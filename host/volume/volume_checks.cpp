#include "volume/volume_checks.h"

#include <fmt/format.h>

#include <cmath>

#include "base/memory.h"

namespace parhelion {

namespace {

std::string megabytes(std::uint64_t bytes) { return fmt::format("{:.1f} MB", static_cast<double>(bytes) * 1e-6); }

}  // namespace

void checkResolution(const SourceLocation& where, glm::i64vec3 resolution) {
    for (int axis = 0; axis < 3; ++axis) {
        if (resolution[axis] < 1 || resolution[axis] > DensityGrid::kMaxResolution)
            throw InputError(where, fmt::format("resolution must be 1 to {} voxels per axis; got {} x {} x {}",
                                                DensityGrid::kMaxResolution, resolution.x, resolution.y, resolution.z));
    }
}

bool areBounds(const glm::dvec3& boundsMin, const glm::dvec3& boundsMax) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(boundsMin[axis] < boundsMax[axis]) || !std::isfinite(boundsMin[axis]) || !std::isfinite(boundsMax[axis]))
            return false;
    return true;
}

void checkBounds(const SourceLocation& where, const glm::dvec3& boundsMin, const glm::dvec3& boundsMax) {
    if (areBounds(boundsMin, boundsMax)) return;
    throw InputError(where,
                     fmt::format("bounds must be finite with minimum < maximum on every axis; got ({}, {}, {}) to "
                                 "({}, {}, {})",
                                 boundsMin.x, boundsMin.y, boundsMin.z, boundsMax.x, boundsMax.y, boundsMax.z));
}

void checkMemory(const SourceLocation& where, std::uint64_t neededBytes, std::size_t limitBytes) {
    const std::uint64_t limit = limitBytes > 0 ? limitBytes : physicalMemoryBytes() / 2;
    if (neededBytes > limit)
        throw InputError(where, fmt::format("the grid needs {} of memory; allowed are {}", megabytes(neededBytes),
                                            megabytes(limit)));
}

void checkValues(const SourceLocation& where, std::span<const float> values, glm::uvec3 resolution, unsigned channels) {
    std::size_t index = 0;
    for (unsigned z = 0; z < resolution.z; ++z)
        for (unsigned y = 0; y < resolution.y; ++y)
            for (unsigned x = 0; x < resolution.x; ++x)
                for (unsigned channel = 0; channel < channels; ++channel) checkValue(where, values[index++], {x, y, z});
}

std::uint64_t gridBytes(glm::uvec3 resolution, std::uint64_t bricks) {
    const glm::u64vec3 counts = (resolution + (DensityGrid::kBrickSize - 1)) / DensityGrid::kBrickSize;
    return counts.x * counts.y * counts.z * sizeof(std::uint32_t) + bricks * DensityGrid::kBrickVoxels * sizeof(float);
}

void throwBadValue(const SourceLocation& where, float value, const glm::i64vec3& voxel) {
    throw InputError(where, fmt::format("voxel ({}, {}, {}): values must be finite and >= 0; got {}", voxel.x, voxel.y,
                                        voxel.z, value));
}

}  // namespace parhelion
