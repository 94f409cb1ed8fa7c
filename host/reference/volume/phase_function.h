#pragma once

#include "reference/core/frame.h"
#include "reference/core/scene.h"
#include "reference/sampling/warp.h"
#include "reference/surface/bsdf.h"

namespace parhelion::reference {

/// Henyey-Greenstein density per steradian, mu = dot(-wo, wi).
///
/// 1 +- mu comes from the squared length of wo +- wi: nothing cancels where the peak is (numerics H5).
/// Source: Henyey and Greenstein 1941, "Diffuse Radiation in the Galaxy".
template <typename Real>
Real evalHenyeyGreenstein(Real g, const Vec3<Real>& wo, const Vec3<Real>& wi) {
    const Real a = std::abs(g);
    const Vec3<Real> d = g >= 0 ? wi + wo : wi - wo;
    const Real distance2 = (1 - a) * (1 - a) + a * glm::dot(d, d);
    return (1 - a) * (1 + a) / (4 * kPi<Real> * distance2 * std::sqrt(distance2));
}

/// Sampled deflection: mu, sin(theta) and the density per steradian.
template <typename Real>
struct Deflection {
    Real mu, sinTheta, pdf;
};

/// Inversion of the Henyey-Greenstein distribution, |g| < 1, u in [0, 1); g = 0 needs no branch (numerics H1-H4).
template <typename Real>
Deflection<Real> sampleHenyeyGreenstein(Real g, Real u) {
    const Real a = std::abs(g);
    const Real v = g >= 0 ? u : 1 - u;
    const Real below = 1 - a, above = 1 + a;
    const Real k = below + 2 * a * v;
    const Real oneMinus = 2 * below * below * (1 - v) * (1 + a * v) / (k * k);
    const Real onePlus = 2 * above * above * v * (below + a * v) / (k * k);
    const Real mu = oneMinus < 1 ? 1 - oneMinus : onePlus - 1;
    const Real flux = below * above;
    return {g < 0 ? -mu : mu, std::sqrt(oneMinus * onePlus), k * k * k / (4 * kPi<Real> * flux * flux)};
}

/// Density per steradian of scattering from -wo to wi.
/// Reference only: within evalScatterer in the shader.
template <typename Real>
Real evalPhase(const Medium<Real>& medium, const Vec3<Real>& wo, const Vec3<Real>& wi) {
    if (medium.isotropic) return 1 / (4 * kPi<Real>);
    return evalHenyeyGreenstein(medium.g, wo, wi);
}

/// Reference only: within sampleScatterer in the shader.
template <typename Real>
DirectionSample<Real> samplePhase(const Medium<Real>& medium, const Vec3<Real>& wo, const Vec2<Real>& u) {
    if (medium.isotropic) return {uniformSphere(u), 1 / (4 * kPi<Real>)};
    const Deflection<Real> deflection = sampleHenyeyGreenstein(medium.g, u.x);
    const Vec2<Real> turn = sinCosTurn(u.y);
    const Vec3<Real> local{deflection.sinTheta * turn.y, deflection.sinTheta * turn.x, deflection.mu};
    return {glm::normalize(toWorld(frameFromNormal(-wo), local)), deflection.pdf};
}

}  // namespace parhelion::reference
