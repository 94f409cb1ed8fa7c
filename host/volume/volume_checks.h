#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>

#include "base/error.h"
#include "volume/density_grid.h"

namespace parhelion {

/// @throws InputError unless every axis has 1 to DensityGrid::kMaxResolution voxels.
void checkResolution(const SourceLocation& where, glm::i64vec3 resolution);

/// Whether the bounds are finite and boundsMin < boundsMax on every axis.
bool areBounds(const glm::dvec3& boundsMin, const glm::dvec3& boundsMax);

/// @throws InputError unless the bounds are finite and boundsMin < boundsMax on every axis.
void checkBounds(const SourceLocation& where, const glm::dvec3& boundsMin, const glm::dvec3& boundsMax);

/// @param limitBytes  0: half of the machine's memory.
/// @throws InputError saying how much is needed and allowed, when `neededBytes` exceeds the limit.
void checkMemory(const SourceLocation& where, std::uint64_t neededBytes, std::size_t limitBytes);

/// Checks values stored x fastest with `channels` interleaved values a voxel.
void checkValues(const SourceLocation& where, std::span<const float> values, glm::uvec3 resolution, unsigned channels);

/// Bytes of a DensityGrid of `resolution` with `bricks` allocated bricks.
std::uint64_t gridBytes(glm::uvec3 resolution, std::uint64_t bricks);

[[noreturn]] void throwBadValue(const SourceLocation& where, float value, const glm::i64vec3& voxel);

/// @throws InputError naming the voxel unless `value` is finite and >= 0.
inline void checkValue(const SourceLocation& where, float value, const glm::i64vec3& voxel) {
    // Written so that NaN fails.
    if (!(value >= 0.0f && value <= std::numeric_limits<float>::max())) throwBadValue(where, value, voxel);
}

}  // namespace parhelion
