#pragma once

#include <span>

#include "reference/geometry/intersection.h"
#include "reference/sampling/sampler.h"

namespace parhelion::reference {

/// Offset of one film coordinate from the pixel's lower edge: the reconstruction filter, importance sampled.
///
/// @param table  inverse CDF at multiples of 1/256, pixels about the centre; empty for the box filter.
template <typename Real>
Real filmOffset(std::span<const float> table, Real u) {
    if (table.empty()) return u;
    const Real s = u * Real(table.size() - 1);
    const auto i = static_cast<std::size_t>(s);
    const Real f = s - Real(i);
    return Real(0.5) + (Real(table[i]) * (1 - f) + Real(table[i + 1]) * f);
}

/// Ray through a random point of the pixel. The camera is at the origin of the compiled scene.
///
/// @param words  of the camera or the feature draw.
template <typename Real>
Ray<Real> generateRay(const SceneView<Real>& scene, glm::uvec2 pixel, const glm::uvec4& words) {
    const shared::Camera& camera = scene.constants.camera;
    const Real x = Real(pixel.x) + filmOffset(std::span(scene.source.filterTable), toUniform<Real>(words.x));
    const Real y = Real(pixel.y) + filmOffset(std::span(scene.source.filterTable), toUniform<Real>(words.y));
    Ray<Real> ray;
    ray.origin = Vec3<Real>(0);
    ray.direction =
        glm::normalize(Vec3<Real>(camera.forward) + x * Vec3<Real>(camera.dx) + y * Vec3<Real>(camera.dy));
    ray.inside = camera.inside;
    return ray;
}

}  // namespace parhelion::reference
