#pragma once

#include <limits>
#include <optional>

#include "reference/core/scene.h"

namespace parhelion::reference {

/// Where a line is inside a convex shape.
template <typename Real>
struct Interval {
    Real t0, t1;
};

/// Bound on the error of intersectQuad: the distance from the plane has 5 roundings of its terms.
///
/// @param slack  uncertainty of the origin.
template <typename Real>
Real quadDistanceError(const Quad<Real>& quad, const Vec3<Real>& origin, const Vec3<Real>& direction, Real slack) {
    const Real terms = glm::dot(glm::abs(quad.normal), glm::abs(quad.corner - origin));
    const Real distance = Real(2.5) * std::numeric_limits<Real>::epsilon() * terms;
    return (distance + slack) / std::abs(glm::dot(quad.normal, direction));
}

/// Distance along the ray to the parallelogram, or nothing. May be negative.
///
/// A point counts as on it if that is within the rounding of its coordinates: 5 of the terms they are summed from, and
/// the error of t. Rays do not slip between parallelograms that share an edge (H47).
template <typename Real>
std::optional<Real> intersectQuad(const Quad<Real>& quad, const Vec3<Real>& origin, const Vec3<Real>& direction) {
    const Vec3<Real> toCorner = quad.corner - origin;
    const Real t = glm::dot(quad.normal, toCorner) / glm::dot(quad.normal, direction);
    if (!std::isfinite(t)) return std::nullopt;  // parallel
    const Vec3<Real> p = t * direction - toCorner;
    const Vec3<Real> terms = glm::abs(t * direction) + glm::abs(toCorner) + glm::abs(quad.corner);
    const Real errorOfT = quadDistanceError(quad, origin, direction, Real(0));
    const auto isWithin = [&](const Vec3<Real>& fromWorld) {
        const Real at = glm::dot(fromWorld, p);
        const Real error = Real(2.5) * std::numeric_limits<Real>::epsilon() * glm::dot(glm::abs(fromWorld), terms) +
                           errorOfT * std::abs(glm::dot(fromWorld, direction));
        return at >= -error && at <= 1 + error;
    };
    if (!isWithin(quad.uFromWorld) || !isWithin(quad.vFromWorld)) return std::nullopt;
    return t;
}

/// The discriminant from the perpendicular component: nothing cancels for far spheres.
///
/// Source: Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems ch. 7.
template <typename Real>
std::optional<Interval<Real>> sphereInterval(const Sphere<Real>& sphere, const Vec3<Real>& origin,
                                             const Vec3<Real>& direction) {
    const Vec3<Real> toCenter = sphere.center - origin;
    const Real middle = glm::dot(toCenter, direction);
    const Vec3<Real> perpendicular = toCenter - middle * direction;
    const Real discriminant = sphere.radius * sphere.radius - glm::dot(perpendicular, perpendicular);
    if (!(discriminant >= 0)) return std::nullopt;
    const Real half = std::sqrt(discriminant);
    return Interval<Real>{middle - half, middle + half};
}

/// Slabs in the box's own space. An axis the ray does not move along limits nothing, or everything (H39).
template <typename Real>
std::optional<Interval<Real>> boxInterval(const Box<Real>& box, const Vec3<Real>& origin, const Vec3<Real>& direction) {
    const Vec3<Real> o = box.localFromWorld.point(origin);
    const Vec3<Real> d = box.localFromWorld.vector(direction);
    Interval<Real> interval{-kInfinity<Real>, kInfinity<Real>};
    for (int i = 0; i < 3; ++i) {
        if (d[i] == 0) {
            if (std::abs(o[i]) > 1) return std::nullopt;
            continue;
        }
        const Real inverse = 1 / d[i];
        const Real a = (-1 - o[i]) * inverse, b = (1 - o[i]) * inverse;
        interval.t0 = std::max(interval.t0, std::min(a, b));
        interval.t1 = std::min(interval.t1, std::max(a, b));
    }
    if (interval.t1 < interval.t0) return std::nullopt;
    return interval;
}

}  // namespace parhelion::reference
