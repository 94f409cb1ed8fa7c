#pragma once

#include "reference/core/frame.h"
#include "reference/core/scene.h"
#include "reference/sampling/distribution.h"
#include "reference/sampling/sampler.h"
#include "reference/sampling/warp.h"
#include "reference/surface/bsdf.h"

namespace parhelion::reference {

/// Henyey-Greenstein density per steradian, mu = dot(-wo, wi).
///
/// 1 +- mu comes from the squared length of wo +- wi: nothing cancels where the peak is (H5).
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

/// Inversion of the Henyey-Greenstein distribution, |g| < 1, u in [0, 1); g = 0 needs no branch (H1-H4).
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

/// Rayleigh density per steradian; the same forwards and backwards.
template <typename Real>
Real evalRayleigh(const Vec3<Real>& wo, const Vec3<Real>& wi) {
    const Real mu = glm::dot(wo, wi);
    return 3 / (16 * kPi<Real>)*(1 + mu * mu);
}

/// The real root of mu^3 + 3 mu = 8 u - 4, in the half where nothing cancels. 1 - mu solves x (6 - 3 x + x^2) = 8 v, v
/// the share beyond: put in once on the right, Cardano's root keeps its digits next to the poles. Source: Frisvad 2011,
/// "Importance sampling the Rayleigh phase function".
template <typename Real>
Deflection<Real> sampleRayleigh(Real u) {
    const Real beyond = std::min(u, 1 - u), z = 2 - 4 * beyond;
    const Real y = std::cbrt(z + std::sqrt(z * z + 1));
    const Real rough = 1 - (y - 1 / y);
    const Real oneMinus = 8 * beyond / (6 - 3 * rough + rough * rough), mu = 1 - oneMinus;
    const Real pdf = 3 / (16 * kPi<Real>)*(1 + mu * mu);
    return {u < Real(0.5) ? -mu : mu, std::sqrt(oneMinus * (1 + mu)), pdf};
}

/// Piecewise linear density per steradian from values at equidistant mu.
///
/// @param values  count + 1 of them, from mu = -1 to 1.
template <typename Real>
Real evalTabulated(const float* values, std::uint32_t count, const Vec3<Real>& wo, const Vec3<Real>& wi) {
    const bool forwards = glm::dot(wo, wi) < 0;
    const Vec3<Real> chord = forwards ? wi + wo : wi - wo;
    const Real fromPole = Real(count) * glm::dot(chord, chord) / 4;  // in intervals
    const std::uint32_t i = std::min(std::uint32_t(fromPole), count - 1);
    const Real t = std::min(fromPole - Real(i), Real(1));
    const Real first = values[forwards ? count - i : i], second = values[forwards ? count - i - 1 : i + 1];
    return first + t * (second - first);
}

/// Inversion within one interval, where the density goes linearly from a to b.
template <typename Real>
Deflection<Real> sampleTabulated(const float* values, std::uint32_t count, const Choice<Real>& choice) {
    const auto [interval, u, rest] = choice;
    const Real low = values[interval], high = values[interval + 1], larger = std::max(low, high);
    const Real a = safeDivide(low, larger), b = safeDivide(high, larger);
    const Real r = std::sqrt(a * a * rest + b * b * u);
    const Real t = std::min(safeDivide(u * (a + b), a + r), Real(1));
    const Real s = std::min(safeDivide(rest * (a + b), b + r), Real(1));
    const Real onePlus = 2 * (Real(interval) + t) / Real(count);
    const Real oneMinus = 2 * (Real(count - 1 - interval) + s) / Real(count);
    return {oneMinus < 1 ? 1 - oneMinus : onePlus - 1, std::sqrt(onePlus * oneMinus), low * s + high * t};
}

/// Density per steradian of scattering from -wo to wi.
template <typename Real>
Real evalPhase(const Medium<Real>& medium, const Vec3<Real>& wo, const Vec3<Real>& wi) {
    switch (medium.phase) {
        case shared::kPhaseHenyeyGreenstein:
            return evalHenyeyGreenstein(medium.g, wo, wi);
        case shared::kPhaseDualHenyeyGreenstein:
            return medium.lobeWeight * evalHenyeyGreenstein(medium.g, wo, wi) +
                   (1 - medium.lobeWeight) * evalHenyeyGreenstein(medium.g2, wo, wi);
        case shared::kPhaseRayleigh:
            return evalRayleigh(wo, wi);
        case shared::kPhaseTabulated:
            return evalTabulated(medium.phaseTable, medium.phaseCount, wo, wi);
        default:
            return 1 / (4 * kPi<Real>);
    }
}

/// The deflection that u gives within the lobe of a dual function that the random word chooses; the density is that of
/// both (H8).
/// Reference only: within samplePhase in the shader.
template <typename Real>
Deflection<Real> sampleLobe(const Medium<Real>& medium, Real u, std::uint32_t choice) {
    const Vec3<Real> wo{0, 0, -1};
    const bool first = toUniform<Real>(choice) < medium.lobeWeight;
    const Real own = first ? medium.lobeWeight : 1 - medium.lobeWeight;
    Deflection<Real> deflection = sampleHenyeyGreenstein(first ? medium.g : medium.g2, u);
    const Vec3<Real> wi{deflection.sinTheta, 0, deflection.mu};
    const Real other = evalHenyeyGreenstein(first ? medium.g2 : medium.g, wo, wi);
    deflection.pdf = own * deflection.pdf + (1 - own) * other;
    return deflection;
}

/// @param words   x and y of a scatter draw.
/// @param choice  random word that picks the lobe of a dual function, and fills up what x says of a tabulated one.
template <typename Real>
DirectionSample<Real> samplePhase(const Medium<Real>& medium, const Vec3<Real>& wo, const glm::uvec2& words,
                                  std::uint32_t choice) {
    const Vec2<Real> u{toUniform<Real>(words.x), toUniform<Real>(words.y)};
    if (medium.phase == shared::kPhaseIsotropic) return {uniformSphere(u), 1 / (4 * kPi<Real>)};
    Deflection<Real> deflection{};
    if (medium.phase == shared::kPhaseHenyeyGreenstein) deflection = sampleHenyeyGreenstein(medium.g, u.x);
    if (medium.phase == shared::kPhaseDualHenyeyGreenstein) deflection = sampleLobe(medium, u.x, choice);
    if (medium.phase == shared::kPhaseRayleigh) deflection = sampleRayleigh(u.x);
    if (medium.phase == shared::kPhaseTabulated) {
        const std::span table(medium.phaseDistribution, medium.phaseCount + 1);
        const Choice<Real> interval = invertDistribution(table, words.x, toUniform<Real>(choice));
        deflection = sampleTabulated(medium.phaseTable, medium.phaseCount, interval);
    }
    const Vec2<Real> turn = sinCosTurn(u.y);
    const Vec3<Real> local{deflection.sinTheta * turn.y, deflection.sinTheta * turn.x, deflection.mu};
    return {glm::normalize(toWorld(frameFromNormal(-wo), local)), deflection.pdf};
}

}  // namespace parhelion::reference
