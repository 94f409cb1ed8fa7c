#pragma once

#include "reference/geometry/bvh.h"
#include "reference/geometry/primitives.h"
#include "reference/geometry/ray.h"
#include "reference/geometry/surface.h"

namespace parhelion::reference {

/// Whether `shape` is `inside` or surrounds it.
template <typename Real>
bool surrounds(const SceneView<Real>& scene, std::uint32_t shape, std::uint32_t inside) {
    while (inside != kNone && inside != shape) inside = scene.shapeAt(inside).exterior;
    return inside != kNone;
}

/// What a convex shape adds to the nearest hit.
///
/// @param hit       the shape; its distance is filled in here.
/// @param interval  where the ray's line is inside the shape, or nothing.
template <typename Real>
void hitConvex(const SceneView<Real>& scene, const Ray<Real>& ray, Hit<Real> hit,
               const std::optional<Interval<Real>>& interval, Hit<Real>& nearest) {
    if (hit.primitive == ray.target) return;
    if (hit.isNull && hit.shape == ray.inside) {
        hit.t = interval ? std::max(interval->t1, ray.tMin) : ray.tMin;
        hit.exits = true;
        if (hit.t < ray.tMax) keepNearer(nearest, hit);
        return;
    }
    if (!interval || !(interval->t1 > ray.tMin)) return;
    const bool isAhead = interval->t0 + interval->t1 > 2 * ray.tMin;
    if (hit.isNull) {
        if (!isAhead || surrounds(scene, hit.shape, ray.inside)) return;
        hit.t = std::max(interval->t0, ray.tMin);
    } else if (hit.primitive == ray.last) {
        // A ray that leaves its own convex surface outwards has the interval's middle behind it.
        if (!isAhead) return;
        hit.t = interval->t1;
    } else {
        hit.t = interval->t0 >= ray.tMin ? interval->t0 : interval->t1;
    }
    if (hit.t < ray.tMax) keepNearer(nearest, hit);
}

/// What a flat primitive adds: an opaque one may be met where the ray has just left a medium.
/// Reference only: the shader has it where it meets quads and triangles.
template <typename Real>
void hitFlat(const Ray<Real>& ray, const Hit<Real>& hit, Hit<Real>& nearest) {
    if (hit.primitive == ray.last || hit.primitive == ray.target) return;
    if (!(hit.isNull ? hit.t > ray.tMin : hit.t >= ray.tMin) || !(hit.t < ray.tMax)) return;
    keepNearer(nearest, hit);
}

/// The first surface or null boundary from ray.tMin on and before ray.tMax.
template <typename Real>
Hit<Real> closestHit(const SceneView<Real>& scene, const Ray<Real>& ray) {
    Hit<Real> nearest, hit;
    hit.primitive = 0;
    for (const Quad<Real>& quad : scene.quads) {
        hit.shape = quad.shape;
        hit.isNull = quad.isNull;
        if (const auto t = intersectQuad(quad, ray.origin, ray.direction)) {
            hit.t = *t;
            hitFlat(ray, hit, nearest);
        }
        ++hit.primitive;
    }
    const auto addConvex = [&](const auto& shape, const std::optional<Interval<Real>>& interval) {
        hit.shape = shape.shape;
        hit.isNull = shape.isNull;
        hitConvex(scene, ray, hit, interval, nearest);
        ++hit.primitive;
    };
    for (const Sphere<Real>& sphere : scene.spheres)
        addConvex(sphere, sphereInterval(sphere, ray.origin, ray.direction));
    for (const Box<Real>& box : scene.boxes) addConvex(box, boxInterval(box, ray.origin, ray.direction));
    if (scene.constants.triangleCount == 0) return nearest;
    const auto addTriangle = [&](std::uint32_t triangle, const TriangleHit<Real>& found) {
        if (found.t > nearest.t) return;
        hit.t = found.t;
        hit.primitive = scene.firstTriangle + triangle;
        hit.shape = scene.triangleShape(triangle);
        hit.isNull = scene.isNull(hit.shape);
        hit.barycentric = {found.b1, found.b2};
        hitFlat(ray, hit, nearest);
    };
    const auto limit = [&] { return std::min(nearest.t, ray.tMax); };
    traverse(scene, ray.origin, ray.direction, ray.tMin, limit, addTriangle);
    return nearest;
}

/// A surface may lie in the boundary of a mesh, or within rounding of it: a ray from the surface can then start beyond
/// the boundary. It has entered the mesh if what it meets first is the mesh's boundary from within.
template <typename Real>
void noticeEntry(const SceneView<Real>& scene, const Hit<Real>& hit, Ray<Real>& ray) {
    if (!hit.found() || !hit.isNull || hit.primitive < scene.firstTriangle) return;
    if (ray.last == kNone || ray.tMin > 0 || surrounds(scene, hit.shape, ray.inside)) return;
    if (glm::dot(ray.direction, flatNormal(scene, hit.primitive)) > 0) ray.inside = hit.shape;
}

/// Takes the ray across the null boundary it has hit.
///
/// @return false when the ray no longer gets anywhere: it alternates between null shapes that overlap.
template <typename Real>
bool crossBoundary(const SceneView<Real>& scene, const Hit<Real>& hit, Ray<Real>& ray) {
    constexpr std::uint32_t kMaxStalls = 64;
    const bool isConvex = hit.primitive >= scene.firstSphere && hit.primitive < scene.firstTriangle;
    const bool enters = isConvex ? !hit.exits : glm::dot(ray.direction, flatNormal(scene, hit.primitive)) < 0;
    if (enters)
        ray.inside = hit.shape;
    else if (ray.inside == hit.shape)
        ray.inside = scene.shapeAt(hit.shape).exterior;
    ray.stalls = hit.t > ray.tMin ? 0 : ray.stalls + 1;
    ray.tMin = hit.t;
    return ray.stalls < kMaxStalls;
}

}  // namespace parhelion::reference
