#pragma once

#include "reference/geometry/bvh.h"
#include "reference/geometry/flat.h"
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

/// The first surface or null boundary from ray.tMin on and before ray.tMax.
template <typename Real>
Hit<Real> closestHit(const SceneView<Real>& scene, const Ray<Real>& ray) {
    Hit<Real> nearest, hit;
    hit.primitive = 0;
    const Real uncertainty = std::max(ray.start.slack, Real(0));
    for (const Quad<Real>& quad : scene.quads) {
        hit.shape = quad.shape;
        hit.isNull = quad.isNull;
        if (const auto t = intersectQuad(quad, ray.origin, ray.direction)) {
            hit.t = *t;
            hitFlat(ray, hit, quadDistanceError(quad, ray.origin, ray.direction, uncertainty), nearest);
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
        if (found.t - found.error > nearest.t) return;
        hit.t = found.t;
        hit.primitive = scene.firstTriangle + triangle;
        hit.shape = scene.triangleShape(triangle);
        hit.isNull = scene.isNull(hit.shape);
        hit.barycentric = {found.b1, found.b2};
        hitFlat(ray, hit, found.error, nearest);
    };
    const auto limit = [&] { return std::min(nearest.t, ray.tMax); };
    traverse(scene, ray.origin, ray.direction, ray.tMin, uncertainty, limit, addTriangle);
    return nearest;
}

/// A surface may lie in the boundary of a mesh, or within rounding of it: a ray from the surface can then start beyond
/// the boundary. It has entered the mesh if what it meets first is the mesh's boundary from within.
template <typename Real>
void noticeEntry(const SceneView<Real>& scene, const Hit<Real>& hit, Ray<Real>& ray) {
    if (!hit.found() || !hit.isNull || hit.near || hit.primitive < scene.firstTriangle) return;
    if (ray.last == kNone || ray.tMin > 0 || surrounds(scene, hit.shape, ray.inside)) return;
    if (glm::dot(ray.direction, flatNormal(scene, hit.primitive)) > 0) ray.inside = hit.shape;
}

/// Goes on behind what the ray has hit.
template <typename Real>
void passHit(const SceneView<Real>& scene, const Hit<Real>& hit, Ray<Real>& ray) {
    const bool hasMoved = hit.t > ray.tMin;
    ray.stalls = hasMoved ? 0 : ray.stalls + 1;
    if (isFlatPrimitive(scene, hit.primitive))
        ray.passed = hit.primitive + 1;
    else if (hasMoved)
        ray.passed = 0;
    ray.tMin = hit.t;
}

/// Takes the ray across the null boundary it has hit.
///
/// @return false when the ray no longer gets anywhere: it alternates between null shapes that overlap.
template <typename Real>
bool crossBoundary(const SceneView<Real>& scene, const Hit<Real>& hit, Ray<Real>& ray) {
    const bool isFlat = isFlatPrimitive(scene, hit.primitive);
    const bool enters = isFlat ? glm::dot(ray.direction, flatNormal(scene, hit.primitive)) < 0 : !hit.exits;
    const bool isWithin = hit.exits || surrounds(scene, hit.shape, ray.inside);
    const auto& idle = ray.idle;
    const bool answersIdle =
        idle.shape == hit.shape && idle.entered != enters && hit.t - idle.t <= Real(shared::kCoincidence) * hit.t;
    if (enters == isWithin)
        ray.idle = {hit.shape, enters, hit.t};
    else if (answersIdle)
        ray.idle = {};
    else
        ray.inside = enters ? hit.shape : scene.shapeAt(hit.shape).exterior;
    passHit(scene, hit, ray);
    // Each primitive is crossed once at one distance, a convex one twice.
    return ray.stalls <= 2 * (scene.firstTriangle + scene.constants.triangleCount);
}

}  // namespace parhelion::reference
