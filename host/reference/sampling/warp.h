#pragma once

#include "reference/core/math.h"

namespace parhelion::reference {

/// Direction of density cos(theta) / pi about +z.
template <typename Real>
Vec3<Real> cosineHemisphere(const Vec2<Real>& u) {
    const Vec2<Real> turn = sinCosTurn(u.y);
    const Real r = std::sqrt(u.x);
    return {r * turn.y, r * turn.x, std::sqrt(std::max(Real(0), 1 - u.x))};
}

/// Direction of density 1 / (4 pi).
template <typename Real>
Vec3<Real> uniformSphere(const Vec2<Real>& u) {
    const Vec2<Real> turn = sinCosTurn(u.y);
    const Real r = 2 * std::sqrt(u.x * (1 - u.x));
    return {r * turn.y, r * turn.x, 1 - 2 * u.x};
}

/// Direction uniform over the cone about +z with the given 1 - cos of its half angle.
/// 1 - cos is kept throughout: a narrow cone loses nothing (H62).
template <typename Real>
Vec3<Real> uniformCone(const Vec2<Real>& u, Real oneMinusCosMax) {
    const Vec2<Real> turn = sinCosTurn(u.y);
    const Real c = oneMinusCosMax * u.x;
    const Real r = std::sqrt(c * (2 - c));
    return {r * turn.y, r * turn.x, 1 - c};
}

/// Barycentric coordinates of a uniform point of a triangle.
template <typename Real>
Vec3<Real> uniformTriangle(const Vec2<Real>& u) {
    const Real s = std::sqrt(u.x);
    const Real b1 = u.y * s;
    return {1 - s, b1, s - b1};
}

}  // namespace parhelion::reference
