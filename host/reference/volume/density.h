#pragma once

#include "reference/core/scene.h"

namespace parhelion::reference {

/// One voxel; indices beyond the grid take the nearest one in it.
template <typename Real>
Real densityVoxel(const Medium<Real>& medium, const glm::ivec3& index) {
    const glm::ivec3 i = glm::clamp(index, glm::ivec3(0), medium.resolution - 1);
    if (!medium.brickTable) {
        const glm::ivec3& n = medium.resolution;
        return Real(medium.density[(std::size_t(i.z) * n.y + i.y) * n.x + i.x]);
    }
    const glm::ivec3 brick = i >> 3, within = i & 7;
    const glm::ivec3 n = (medium.resolution + 7) >> 3;
    const std::uint32_t first = medium.brickTable[(std::size_t(brick.z) * n.y + brick.y) * n.x + brick.x];
    if (first == shared::kEmptyBrick) return 0;
    return Real(medium.density[std::size_t(first) + (within.z * 8 + within.y) * 8 + within.x]);
}

/// floor per component, for |v| up to 2^30 (beyond, the integer stays there); without SSE 4.1 std::floor is a call.
/// Reference only: a built-in function in the shader.
template <typename Real>
glm::ivec3 floorToInt(const Vec3<Real>& v) {
    const glm::ivec3 i(glm::clamp(v, Vec3<Real>(Real(-0x1p30)), Vec3<Real>(Real(0x1p30))));
    return i - glm::ivec3(v.x < Real(i.x), v.y < Real(i.y), v.z < Real(i.z));
}

/// Corner of the interpolation chosen at random: floor + (u < fraction) per axis.
template <typename Real>
glm::ivec3 stochasticCorner(const Vec3<Real>& gridPosition, const Vec3<Real>& u) {
    const Vec3<Real> s = gridPosition - Real(0.5);
    const glm::ivec3 low = floorToInt(s);
    const Vec3<Real> fraction = s - Vec3<Real>(low);
    return low + glm::ivec3(u.x < fraction.x, u.y < fraction.y, u.z < fraction.z);
}

/// Density of one corner, chosen by three uniforms: unbiased, for density enters every estimator linearly.
template <typename Real>
Real stochasticDensity(const Medium<Real>& medium, const Vec3<Real>& gridPosition, const Vec3<Real>& offsets) {
    return densityVoxel(medium, stochasticCorner(gridPosition, offsets));
}

/// Trilinear interpolation between voxel centres.
template <typename Real>
Real trilinearDensity(const Medium<Real>& medium, const Vec3<Real>& gridPosition) {
    const Vec3<Real> s = gridPosition - Real(0.5);
    const glm::ivec3 i = floorToInt(s);
    const Vec3<Real> f = s - Vec3<Real>(i);
    const auto alongX = [&](int y, int z) {
        const Real a = densityVoxel(medium, i + glm::ivec3(0, y, z)), b = densityVoxel(medium, i + glm::ivec3(1, y, z));
        return a * (1 - f.x) + b * f.x;
    };
    const Real near = alongX(0, 0) * (1 - f.y) + alongX(1, 0) * f.y;
    const Real far = alongX(0, 1) * (1 - f.y) + alongX(1, 1) * f.y;
    return near * (1 - f.z) + far * f.z;
}

/// Density at a position in voxel units, from one corner (unbiased) or from all eight.
///
/// @param offsets  three uniforms that choose the corner.
template <typename Real>
Real densityAt(const Medium<Real>& medium, const Vec3<Real>& gridPosition, const Vec3<Real>& offsets, bool stochastic) {
    return stochastic ? stochasticDensity(medium, gridPosition, offsets) : trilinearDensity(medium, gridPosition);
}

/// Single-scattering albedo at a world position; a grid's corner is chosen by three uniforms.
template <typename Real>
Vec3<Real> albedoAt(const Medium<Real>& medium, const Vec3<Real>& position, const Vec3<Real>& offsets) {
    if (!medium.albedoVoxels) return medium.albedo;
    const glm::ivec3& n = medium.albedoResolution;
    const glm::ivec3 corner = stochasticCorner(medium.albedoFromWorld.point(position), offsets);
    const glm::ivec3 i = glm::clamp(corner, glm::ivec3(0), n - 1);
    return Vec3<Real>(medium.albedoVoxels[(std::size_t(i.z) * n.y + i.y) * n.x + i.x]);
}

}  // namespace parhelion::reference
