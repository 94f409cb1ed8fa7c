#pragma once

#include <span>

#include "reference/geometry/intersection.h"
#include "reference/sampling/sampler.h"

namespace parhelion::reference {

/// Offset of one film coordinate from the pixel's lower edge: the reconstruction filter, importance sampled.
///
/// @param table  inverse CDF at multiples of 1/256, pixels about the centre; empty for the box filter.
template <typename Real>
Real filterOffset(std::span<const float> table, Real u) {
    if (table.empty()) return u;
    const Real s = u * Real(table.size() - 1);
    const auto i = static_cast<std::size_t>(s);
    const Real f = s - Real(i);
    return Real(0.5) + (Real(table[i]) * (1 - f) + Real(table[i + 1]) * f);
}

/// A random point of the film about the pixel, in pixels from the top left.
template <typename Real>
Vec2<Real> filmPosition(const SceneView<Real>& scene, glm::uvec2 pixel, const Vec2<Real>& u) {
    const std::span<const float> table(scene.source.filterTable);
    return Vec2<Real>(pixel) + Vec2<Real>(filterOffset(table, u.x), filterOffset(table, u.y));
}

/// Unit direction from the camera through a film position.
template <typename Real>
Vec3<Real> cameraDirection(const SceneView<Real>& scene, const Vec2<Real>& film) {
    const shared::Camera& camera = scene.constants.camera;
    return glm::normalize(Vec3<Real>(camera.forward) + film.x * Vec3<Real>(camera.dx) + film.y * Vec3<Real>(camera.dy));
}

/// Ray through a random point of the pixel. The camera is at the origin of the compiled scene.
/// Reference only: the shader writes the ray into its path state.
///
/// @param words  of the camera or the feature draw.
template <typename Real>
Ray<Real> generateRay(const SceneView<Real>& scene, glm::uvec2 pixel, const glm::uvec4& words) {
    const Vec2<Real> u{toUniform<Real>(words.x), toUniform<Real>(words.y)};
    Ray<Real> ray;
    ray.origin = Vec3<Real>(0);
    ray.direction = cameraDirection(scene, filmPosition(scene, pixel, u));
    ray.inside = scene.constants.camera.inside;
    return ray;
}

}  // namespace parhelion::reference
