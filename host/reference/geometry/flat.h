#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "reference/core/scene.h"
#include "reference/geometry/ray.h"

namespace parhelion::reference {

/// Whether it is a quad or a triangle.
template <typename Real>
bool isFlatPrimitive(const SceneView<Real>& scene, std::uint32_t primitive) {
    return primitive != kNone && (primitive < scene.firstSphere || primitive >= scene.firstTriangle);
}

/// Corners of a quad or triangle, a triangle's first one twice.
/// Reference only: the shader has them from the surface it met.
template <typename Real>
std::array<Vec3<Real>, 4> flatCorners(const SceneView<Real>& scene, std::uint32_t primitive) {
    if (primitive < scene.firstSphere) {
        const Quad<Real>& quad = scene.quads[primitive];
        return {quad.corner, quad.corner + quad.edgeU, quad.corner + quad.edgeV,
                quad.corner + (quad.edgeU + quad.edgeV)};
    }
    const std::uint32_t triangle = primitive - scene.firstTriangle;
    return {scene.vertex(triangle, 0), scene.vertex(triangle, 1), scene.vertex(triangle, 2), scene.vertex(triangle, 0)};
}

/// Whether the ray goes on past the opaque flat primitive it has hit: one that it starts in within rounding, and that
/// lies in the plane of the one it left, is folded away from its side, or leads beside its way.
///
/// @param metNormal  unit normal of the one it has hit, either side.
template <typename Real>
bool leavesAside(const SceneView<Real>& scene, const Ray<Real>& ray, const Hit<Real>& hit,
                 const Vec3<Real>& metNormal) {
    if (!hit.near) return false;
    const auto corners = flatCorners(scene, hit.primitive);
    const auto& start = ray.start;
    const bool isNext = start.edge != Vec3<Real>(0);
    Vec3<Real> up = start.normal;
    if (isNext) {
        // Cross products of a sliver's edges are far from normal to them; this one is.
        const Vec3<Real> n = glm::normalize(glm::cross(start.edge, start.inward));
        up = glm::dot(n, start.normal) < 0 ? -n : n;
    }
    if (glm::dot(start.normal, ray.direction) < 0) up = -up;
    Real reach = 0;
    Vec3<Real> size(0);
    for (const Vec3<Real>& corner : corners) {
        reach = std::max(reach, glm::dot(up, corner - ray.origin));
        size = glm::max(size, glm::abs(corner - ray.origin));
    }
    const bool rises = reach > 5 * std::numeric_limits<Real>::epsilon() * glm::dot(glm::abs(up), size) + start.slack;
    if (!rises) return true;
    if (!isNext) return !(hit.t > 0);
    const Real heading = glm::dot(metNormal, ray.direction), level = glm::dot(metNormal, up);
    if (std::abs(level) > Real(0.99)) return !(heading * level < 0);
    const Real along = glm::dot(metNormal, start.edge);
    Vec3<Real> inward = start.inward;
    if (std::abs(along) < Real(1) / 128) inward -= start.edge * glm::dot(start.edge, inward);
    return glm::dot(metNormal, inward) > 0 ? heading > 0 : heading < 0;
}

}  // namespace parhelion::reference
