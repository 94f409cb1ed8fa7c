#pragma once

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
    std::uint32_t stalls = 0;      ///< boundaries crossed since the ray last moved
};

template <typename Real>
struct Hit {
    Real t = kInfinity<Real>;
    std::uint32_t primitive = kNone;
    std::uint32_t shape = kNone;
    Vec2<Real> barycentric{0};  ///< of a triangle's second and third vertex
    bool isNull = false;
    bool exits = false;  ///< leaves the convex null shape the ray is inside

    /// Reference only: the shader compares with kNone.
    bool found() const { return primitive != kNone; }
};

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

}  // namespace parhelion::reference
