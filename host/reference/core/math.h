#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>

namespace parhelion::reference {

template <typename Real>
using Vec2 = glm::vec<2, Real>;
template <typename Real>
using Vec3 = glm::vec<3, Real>;

template <typename Real>
inline constexpr Real kPi = std::numbers::pi_v<Real>;
template <typename Real>
inline constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

/// a / b, or 0 when b is 0.
template <typename Real>
Real safeDivide(Real a, Real b) {
    return b == 0 ? Real(0) : a / b;
}

template <typename Real>
Real maxComponent(const Vec3<Real>& v) {
    return std::max(v.x, std::max(v.y, v.z));
}

/// log(x) for x > 0.
template <typename Real>
Real logPositive(Real x) {
    return std::log(x);
}

/// exp(x) for x <= 0.
template <typename Real>
Real expNegative(Real x) {
    return std::exp(x);
}

/// sqrt(x) rounded to nearest.
template <typename Real>
Real roundedSqrt(Real x) {
    return std::sqrt(x);
}

/// Angle of (x, y) from the x axis, in (-pi, pi]; 0 when both are 0.
template <typename Real>
Real angleOf(Real y, Real x) {
    return x == 0 && y == 0 ? Real(0) : std::atan2(y == 0 ? Real(0) : y, x);
}

/// (sin, cos) of 2 pi u, u in [0, 1).
template <typename Real>
Vec2<Real> sinCosTurn(Real u) {
    const Real angle = 2 * kPi<Real> * u;
    return {std::sin(angle), std::cos(angle)};
}

}  // namespace parhelion::reference
