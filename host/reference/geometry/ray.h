#pragma once

#include <algorithm>
#include <cstdint>

#include "reference/core/math.h"
#include "reference/core/scene.h"

namespace parhelion::reference {

/// A ray keeps origin and direction while it crosses null boundaries: only tMin moves.
template <typename Real>
struct Ray {
    Vec3<Real> origin, direction;  ///< direction: unit
    Real tMin = 0;
    Real tMax = kInfinity<Real>;
    std::uint32_t last = kNone;    ///< primitive the ray starts on
    std::uint32_t target = kNone;  ///< primitive to ignore: the light a shadow ray goes to
    std::uint32_t inside = kNone;  ///< shape whose interior surrounds the ray at tMin
    std::uint32_t passed = 0;      ///< flat primitives with ids below it are done with at tMin
    std::uint32_t stalls = 0;      ///< boundaries crossed since the ray last moved

    /// The flat surface that the ray leaves.
    struct Start {
        Vec2<Real> weights{0};  ///< of its second and third corner in the point that the ray starts from
        Real slack = -1;        ///< how far the ray's start may lie off it; negative: the ray leaves none
    } start;

    /// The last crossing that changed nothing.
    struct Idle {
        std::uint32_t shape = kNone;
        bool entered = false;
        Real t = 0;
    } idle;
};

template <typename Real>
struct Hit {
    Real t = kInfinity<Real>;
    std::uint32_t primitive = kNone;
    std::uint32_t shape = kNone;
    Vec2<Real> barycentric{0};  ///< of a triangle's second and third vertex
    bool isNull = false;
    bool exits = false;  ///< leaves the convex null shape the ray is inside
    bool near = false;   ///< flat, and the ray starts in it within rounding

    /// Reference only: the shader compares with kNone.
    bool found() const { return primitive != kNone; }
};

/// Whether a flat primitive on the ray's line at distance t is still to come: at tMin, by its id.
template <typename Real>
bool isAhead(const Ray<Real>& ray, Real t, std::uint32_t primitive) {
    return t == ray.tMin ? primitive >= ray.passed : t > ray.tMin;
}

/// Keeps the nearer of two candidates. Equal distances: an exit first, then the lowest primitive id (H46).
template <typename Real>
void keepNearer(Hit<Real>& nearest, const Hit<Real>& candidate) {
    if (!(candidate.t <= nearest.t)) return;
    if (candidate.t == nearest.t) {
        const bool isWorse =
            candidate.exits == nearest.exits ? candidate.primitive >= nearest.primitive : nearest.exits;
        if (isWorse) return;
    }
    nearest = candidate;
}

/// What a flat primitive adds.
///
/// @param hit    with the distance as computed.
/// @param error  bound of that distance's error.
template <typename Real>
void hitFlat(const Ray<Real>& ray, Hit<Real> hit, Real error, Hit<Real>& nearest) {
    if (hit.primitive == ray.last || hit.primitive == ray.target) return;
    if (ray.start.slack >= 0 && -error <= hit.t && hit.t <= error) {
        hit.near = true;
        hit.t = std::max(hit.t, Real(0));
    }
    if (isAhead(ray, hit.t, hit.primitive) && hit.t < ray.tMax) keepNearer(nearest, hit);
}

}  // namespace parhelion::reference
