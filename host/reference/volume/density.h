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

/// The densities of one voxel of a medium with a value a channel; indices beyond the grid take the nearest one in it.
template <typename Real>
Vec3<Real> colorVoxel(const Medium<Real>& medium, const glm::ivec3& index) {
    const glm::ivec3& n = medium.resolution;
    const glm::ivec3 i = glm::clamp(index, glm::ivec3(0), n - 1);
    const float* values = medium.density + 3 * ((std::size_t(i.z) * n.y + i.y) * n.x + i.x);
    return {Real(values[0]), Real(values[1]), Real(values[2])};
}

/// Density of each channel in one voxel.
template <typename Real>
Vec3<Real> voxelAt(const Medium<Real>& medium, const glm::ivec3& index) {
    return medium.colored ? colorVoxel(medium, index) : Vec3<Real>(densityVoxel(medium, index));
}

/// Trilinear interpolation between voxel centres: the sum over the eight corners.
template <typename Real>
Vec3<Real> trilinearDensity(const Medium<Real>& medium, const Vec3<Real>& gridPosition) {
    const Vec3<Real> s = gridPosition - Real(0.5);
    const glm::ivec3 low = floorToInt(s);
    const Vec3<Real> f = s - Vec3<Real>(low);
    Vec3<Real> sum(0);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 c(corner & 1, corner >> 1 & 1, corner >> 2);
        const Vec3<Real> w = glm::mix(Real(1) - f, f, Vec3<Real>(c));
        sum += w.x * w.y * w.z * voxelAt(medium, low + c);
    }
    return sum;
}

/// Density of each channel at a position in voxel units: from one corner (unbiased, for density enters every estimator
/// linearly) or from all eight.
///
/// @param offsets  three uniforms that choose the corner, the same for all channels.
template <typename Real>
Vec3<Real> densityAt(const Medium<Real>& medium, const Vec3<Real>& gridPosition, const Vec3<Real>& offsets,
                     bool stochastic) {
    if (stochastic) return voxelAt(medium, stochasticCorner(gridPosition, offsets));
    return trilinearDensity(medium, gridPosition);
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
