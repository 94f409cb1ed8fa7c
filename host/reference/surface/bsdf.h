#pragma once

#include "reference/core/frame.h"
#include "reference/sampling/warp.h"

namespace parhelion::reference {

/// A sampled direction (away from the vertex) and its density per steradian.
template <typename Real>
struct DirectionSample {
    Vec3<Real> direction;
    Real pdf;
};

/// Lambertian scattering of unit reflectance, cosine included: max(cos, 0) / pi.
template <typename Real>
Real evalDiffuse(const Vec3<Real>& normal, const Vec3<Real>& wi) {
    return std::max(Real(0), glm::dot(normal, wi)) / kPi<Real>;
}

template <typename Real>
DirectionSample<Real> sampleDiffuse(const Vec3<Real>& normal, const Vec2<Real>& u) {
    const Vec3<Real> local = cosineHemisphere(u);
    return {glm::normalize(toWorld(frameFromNormal(normal), local)), local.z / kPi<Real>};
}

/// Density of sampleDiffuse per steradian.
template <typename Real>
Real pdfDiffuse(const Vec3<Real>& normal, const Vec3<Real>& wi) {
    return std::max(Real(0), glm::dot(normal, wi)) / kPi<Real>;
}

}  // namespace parhelion::reference
