#pragma once

#include <span>

#include "reference/geometry/intersection.h"
#include "reference/sampling/sampler.h"

namespace parhelion::reference {

/// Offset from the pixel's centre along one axis of the reconstruction filter, importance sampled [pixels].
///
/// @param table  inverse CDF at multiples of 1 / kFilterSteps.
template <typename Real>
Real filterOffset(std::span<const float> table, Real u) {
    const Real s = u * Real(shared::kFilterSteps);
    const std::size_t i = std::min(static_cast<std::size_t>(s), std::size_t(shared::kFilterSteps - 1));
    const Real f = s - Real(i);
    return Real(table[i]) * (1 - f) + Real(table[i + 1]) * f;
}

/// Share of one axis of the filter that lies within some whole pixels beyond its own.
template <typename Real>
Real filterShare(const SceneView<Real>& scene, std::uint32_t pixels) {
    if (pixels >= scene.constants.camera.filterEdges) return 1;
    return Real(scene.source.filterTable[shared::kFilterSteps + 1 + pixels]);
}

/// A random point of the film about the pixel, in pixels from the top left. The filter ends where the film does.
template <typename Real>
Vec2<Real> filmPosition(const SceneView<Real>& scene, glm::uvec2 pixel, const Vec2<Real>& u) {
    const shared::Camera& camera = scene.constants.camera;
    Vec2<Real> position(pixel);
    for (int axis = 0; axis < 2; ++axis) {
        if (!camera.hasFilter) {
            position[axis] += u[axis];
            continue;
        }
        const Real low = 1 - filterShare(scene, pixel[axis] - camera.filmLower[axis]);
        const Real high = filterShare(scene, camera.filmUpper[axis] - 1 - pixel[axis]);
        position[axis] += Real(0.5) + filterOffset(std::span(scene.source.filterTable), low + u[axis] * (high - low));
    }
    return position;
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
