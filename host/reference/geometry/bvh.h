#pragma once

#include <array>
#include <cassert>
#include <cstdint>

#include "reference/core/scene.h"
#include "reference/geometry/triangle.h"

namespace parhelion::reference {

/// The ray's part of the slab test.
template <typename Real>
struct BoundsRay {
    Vec3<Real> origin, inverse;
    Real slack;  ///< uncertainty of the origin: bounds are widened by it, for faces that the ray starts just beyond
};

/// Reference only: the shader divides where it sets up the traversal.
template <typename Real>
BoundsRay<Real> prepareBoundsRay(const Vec3<Real>& origin, const Vec3<Real>& direction, Real slack) {
    Vec3<Real> inverse;
    // The largest finite number for 1 / 0: a plane through the origin gives 0, not 0 * infinity.
    for (int i = 0; i < 3; ++i) inverse[i] = direction[i] == 0 ? std::numeric_limits<Real>::max() : 1 / direction[i];
    return {origin, inverse, slack};
}

/// What distances to bounds are widened by: more than the slab test rounds.
///
/// Source: Ize 2013, "Robust BVH Ray Traversal", JCGT 2(2).
template <typename Real>
inline constexpr Real kBoundsMargin = 1 + 8 * std::numeric_limits<Real>::epsilon();

/// What the distances a hit must lie between are widened by where they prune bounds: distances to triangles round in
/// proportion to the triangle's width.
template <typename Real>
inline constexpr Real kDistanceMargin = Real(0.001);

/// Distance at which the ray enters the bounds, or infinity when it misses [tMin, tMax] of them.
/// No triangle within is missed.
template <typename Real>
Real boxEntry(const glm::vec4& low, const glm::vec4& high, const BoundsRay<Real>& ray, Real tMin, Real tMax) {
    const Vec3<Real> a = (Vec3<Real>(low) - (ray.origin + ray.slack)) * ray.inverse;
    const Vec3<Real> b = (Vec3<Real>(high) - (ray.origin - ray.slack)) * ray.inverse;
    const Vec3<Real> near = glm::min(a, b), far = glm::max(a, b);
    const Real enter = std::max(std::max(near.x, near.y), near.z);
    const Real leave = std::min(std::min(far.x, far.y), far.z) * kBoundsMargin<Real>;
    const bool missed = enter > leave || leave < tMin || enter > tMax * kBoundsMargin<Real>;
    return missed ? kInfinity<Real> : enter;
}

/// Calls accept(triangle, TriangleHit) for every triangle of a leaf that the ray's line meets.
///
/// @param slack  uncertainty of the ray's origin.
template <typename Real, typename Accept>
void hitLeaf(const SceneView<Real>& scene, const TriangleRay<Real>& ray, std::int32_t leaf, Real slack,
             Accept&& accept) {
    const auto packed = static_cast<std::uint32_t>(~leaf);
    for (std::uint32_t i = packed >> 3, end = i + (packed & 7u); i < end; ++i)
        if (const auto hit = intersectTriangle(ray, scene.vertex(i, 0), scene.vertex(i, 1), scene.vertex(i, 2), slack))
            accept(i, *hit);
}

/// Visits every triangle whose leaf the ray meets in [tMin, limit()], near leaves first.
///
/// @param slack   uncertainty of the origin: faces that it lies just beyond are met as well.
/// @param limit   () -> Real: distance beyond which nothing matters; read again as it shrinks.
/// @param accept  (triangle, TriangleHit): called for each hit, in any order, perhaps twice.
template <typename Real, typename Limit, typename Accept>
void traverse(const SceneView<Real>& scene, const Vec3<Real>& origin, const Vec3<Real>& direction, Real tMin,
              Real slack, Limit&& limit, Accept&& accept) {
    struct Pending {
        std::int32_t node;
        Real enter;
    };
    const TriangleRay<Real> triangleRay = rayShear(origin, direction);
    const BoundsRay<Real> boundsRay = prepareBoundsRay(origin, direction, slack);
    std::array<Pending, shared::kBvhStackSize> stack;
    std::size_t depth = 0;
    const Real tLow = tMin * (1 - kDistanceMargin<Real>);
    stack[depth++] = {0, tLow};
    while (depth > 0) {
        const Pending next = stack[--depth];
        const Real tMax = limit() * (1 + kDistanceMargin<Real>);
        if (next.enter > tMax * kBoundsMargin<Real>) continue;
        if (next.node < 0) {
            hitLeaf(scene, triangleRay, next.node, slack, accept);
            continue;
        }
        const glm::vec4* texels = &scene.source.bvhNodes[std::size_t(next.node) * shared::kBvhNodeTexels];
        Pending near{glm::floatBitsToInt(texels[0].w), boxEntry(texels[0], texels[1], boundsRay, tLow, tMax)};
        Pending far{glm::floatBitsToInt(texels[2].w), boxEntry(texels[2], texels[3], boundsRay, tLow, tMax)};
        if (far.enter < near.enter) std::swap(near, far);
        assert(depth + 2 <= stack.size());
        if (far.enter < kInfinity<Real>) stack[depth++] = far;
        if (near.enter < kInfinity<Real>) stack[depth++] = near;
    }
}

}  // namespace parhelion::reference
