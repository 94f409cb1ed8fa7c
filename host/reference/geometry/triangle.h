#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "reference/core/math.h"

namespace parhelion::reference {

/// The ray's part of the watertight test: the axis it mostly moves along becomes z, and a shear
/// makes the ray that axis.
template <typename Real>
struct TriangleRay {
    Vec3<Real> origin;
    int kx, ky, kz;
    Vec3<Real> shear;
};

template <typename Real>
struct TriangleHit {
    Real t;
    Real b1, b2;  ///< barycentric coordinates of the second and third vertex
    Real error;   ///< bound on the error of t
};

template <typename Real>
TriangleRay<Real> rayShear(const Vec3<Real>& origin, const Vec3<Real>& direction) {
    const Vec3<Real> a = glm::abs(direction);
    TriangleRay<Real> ray;
    ray.origin = origin;
    ray.kz = a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
    ray.kx = (ray.kz + 1) % 3;
    ray.ky = (ray.kx + 1) % 3;
    if (direction[ray.kz] < 0) std::swap(ray.kx, ray.ky);
    const Real invZ = 1 / direction[ray.kz];
    ray.shear = {direction[ray.kx] * invZ, direction[ray.ky] * invZ, invZ};
    return ray;
}

/// Bound on the error of the distance to a triangle, of the vertices in the sheared space.
///
/// @param size   largest coordinates of all three on each axis.
/// @param edge   largest edge function; det: their sum. Where that may be 0 the bound is infinite.
/// @param scale  a distance is z times it.
/// @param slack  uncertainty of the ray's origin: of z once, of the sheared x and y twice.
///
/// Source: Pharr, Jakob, Humphreys 2023, "Physically Based Rendering", 4th ed., section 6.8.7.
template <typename Real>
Real distanceError(const Vec3<Real>& size, Real edge, Real det, Real scale, Real slack) {
    constexpr Real kUnit = std::numeric_limits<Real>::epsilon() / 2;
    const Real deltaZ = 3 * kUnit * size.z + slack;
    const Real deltaX = 5 * kUnit * (size.x + size.z) + 2 * slack, deltaY = 5 * kUnit * (size.y + size.z) + 2 * slack;
    const Real deltaEdge = 2 * (2 * kUnit * size.x * size.y + deltaY * size.x + deltaX * size.y);
    const Real least = std::max(std::abs(det) - 3 * deltaEdge, Real(0));
    return 3 * (3 * kUnit * edge * size.z + deltaEdge * size.z + deltaZ * edge) * std::abs(scale) / least;
}

/// Watertight: a ray through a shared edge hits at least one of the two triangles (H47). No culling.
///
/// Source: Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection", JCGT 2(1).
template <typename Real>
std::optional<TriangleHit<Real>> intersectTriangle(const TriangleRay<Real>& ray, const Vec3<Real>& v0,
                                                   const Vec3<Real>& v1, const Vec3<Real>& v2, Real slack = 0) {
    const Vec3<Real> a = v0 - ray.origin, b = v1 - ray.origin, c = v2 - ray.origin;
    const Real ax = a[ray.kx] - ray.shear.x * a[ray.kz], ay = a[ray.ky] - ray.shear.y * a[ray.kz];
    const Real bx = b[ray.kx] - ray.shear.x * b[ray.kz], by = b[ray.ky] - ray.shear.y * b[ray.kz];
    const Real cx = c[ray.kx] - ray.shear.x * c[ray.kz], cy = c[ray.ky] - ray.shear.y * c[ray.kz];
    const Real u = cx * by - cy * bx;
    const Real v = ax * cy - ay * cx;
    const Real w = bx * ay - by * ax;
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
    const Real det = u + v + w;
    if (det == 0) return std::nullopt;
    const Real scaledT = u * (ray.shear.z * a[ray.kz]) + v * (ray.shear.z * b[ray.kz]) + w * (ray.shear.z * c[ray.kz]);
    const auto largest = [](Real p, Real q, Real r) { return std::max({std::abs(p), std::abs(q), std::abs(r)}); };
    const Vec3<Real> size(largest(ax, bx, cx), largest(ay, by, cy), largest(a[ray.kz], b[ray.kz], c[ray.kz]));
    const Real error = distanceError(size, largest(u, v, w), det, ray.shear.z, slack);
    return TriangleHit<Real>{scaledT / det, v / det, w / det, error};
}

}  // namespace parhelion::reference
