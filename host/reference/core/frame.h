#pragma once

#include "reference/core/math.h"

namespace parhelion::reference {

/// Right-handed orthonormal basis.
template <typename Real>
struct Frame {
    Vec3<Real> tangent, bitangent, normal;
};

/// Basis about a unit normal, without a singular direction.
///
/// Source: Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1).
template <typename Real>
Frame<Real> frameFromNormal(const Vec3<Real>& n) {
    // Not the sign bit: normals get a negative zero when they are flipped, which must not turn the basis.
    const Real sign = n.z >= 0 ? Real(1) : Real(-1);
    const Real a = Real(-1) / (sign + n.z);
    const Real b = n.x * n.y * a;
    return {Vec3<Real>(1 + sign * n.x * n.x * a, sign * b, -sign * n.x), Vec3<Real>(b, sign + n.y * n.y * a, -n.y), n};
}

/// Direction given in the frame, in world space.
template <typename Real>
Vec3<Real> toWorld(const Frame<Real>& frame, const Vec3<Real>& local) {
    return frame.tangent * local.x + frame.bitangent * local.y + frame.normal * local.z;
}

}  // namespace parhelion::reference
