#pragma once

#include "reference/core/frame.h"
#include "reference/core/scene.h"
#include "reference/sampling/distribution.h"
#include "reference/sampling/sampler.h"
#include "reference/sampling/warp.h"

namespace parhelion::reference {

/// base^power; 0^0 = 1. The complement 1 - base is for the shader: the oracle has digits enough.
template <typename Real>
Real unitPower(Real base, Real /*complement*/, Real power) {
    return std::pow(base, power);
}

/// Radiance of the sky between the stars, by the formula as it is written.
template <typename Real>
Vec3<Real> skyGradient(const SceneView<Real>& scene, const Vec3<Real>& d) {
    const shared::Sky& sky = scene.constants.sky;
    const Real width(sky.width), half(0.5);
    const Real tRaw = (glm::dot(glm::normalize(d), glm::normalize(Vec3<Real>(sky.axis))) + 1) / 2;
    const Real above = tRaw + Real(sky.offset) - half;
    const Real s = width == 0 ? Real(above >= 0) : std::clamp(above / width + half, Real(0), Real(1));
    const Real t = unitPower(s, 1 - s, Real(sky.power));
    return (1 - t) * Vec3<Real>(sky.bottom) + t * Vec3<Real>(sky.top);
}

/// Index of the lookup cell that holds a direction.
template <typename Real>
std::uint32_t starCell(const SceneView<Real>& scene, const Vec3<Real>& d) {
    const std::uint32_t cells = scene.constants.sky.starCells;
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(d[i]) > std::abs(d[axis])) axis = i;
    const auto coordinate = [&](int i) {
        const Real onFace = (d[i % 3] / std::abs(d[axis]) + 1) / 2;
        return std::min(std::uint32_t(std::max(onFace * Real(cells), Real(0))), cells - 1);
    };
    const std::uint32_t face = 2 * std::uint32_t(axis) + (d[axis] < 0 ? 1 : 0);
    return (face * cells + coordinate(axis + 2)) * cells + coordinate(axis + 1);
}

/// The star whose disc holds a direction, or kNone.
template <typename Real>
std::uint32_t findStar(const SceneView<Real>& scene, const Vec3<Real>& d) {
    if (scene.constants.sky.starCells == 0) return kNone;
    const std::vector<std::uint32_t>& words = scene.source.starCells;
    const std::uint32_t run = words[starCell(scene, d)];
    for (const std::uint32_t star : std::span(words).subspan(run >> 4, run & 15u)) {
        const glm::vec4& disc = scene.source.stars[2 * star];
        const Vec3<Real> chord = d - Vec3<Real>(disc);
        if (glm::dot(chord, chord) <= 2 * Real(disc.w)) return star;
    }
    return kNone;
}

/// A direction and the star that holds it (or kNone).
template <typename Real>
struct SkyPoint {
    Vec3<Real> direction;
    std::uint32_t star;
};

template <typename Real>
Vec3<Real> skyRadiance(const SceneView<Real>& scene, const SkyPoint<Real>& point) {
    const Vec3<Real> gradient = skyGradient(scene, point.direction);
    if (point.star == kNone) return gradient;
    return gradient + Real(scene.source.stars[2 * point.star + 1].x) * Vec3<Real>(scene.constants.sky.starRadiance);
}

/// Density per steradian with which sampleSky finds the point.
template <typename Real>
Real skyPdf(const SceneView<Real>& scene, const SkyPoint<Real>& point) {
    const shared::Sky& sky = scene.constants.sky;
    const Real height = (glm::dot(point.direction, glm::normalize(Vec3<Real>(sky.axis))) + 1) / 2;
    const auto band = std::uint32_t(std::max(height * Real(sky.bandCount), Real(0)));
    const Real gradient(scene.source.skyBands[std::min(band, sky.bandCount - 1)]);
    return point.star == kNone ? gradient : gradient + Real(scene.source.stars[2 * point.star + 1].y);
}

/// A point of the sky.
///
/// @param words  x, y and z of a light draw.
template <typename Real>
SkyPoint<Real> sampleSky(const SceneView<Real>& scene, const glm::uvec3& words) {
    const shared::Sky& sky = scene.constants.sky;
    const auto table =
        std::span(scene.source.distributions).subspan(sky.distribution, sky.bandCount + sky.starCount + 1);
    const auto [entry, offset, left] = invertDistribution(table, words.x, fillDigits<Real>(words.z).x);
    const Vec2<Real> u{offset, toUniform<Real>(words.y)};
    if (entry >= sky.bandCount) {
        const std::uint32_t star = entry - sky.bandCount;
        const glm::vec4& disc = scene.source.stars[2 * star];
        const Frame<Real> frame = frameFromNormal(glm::normalize(Vec3<Real>(disc)));
        return {glm::normalize(toWorld(frame, uniformCone(u, Real(disc.w)))), star};
    }
    const Real onePlus = 2 * (Real(entry) + offset) / Real(sky.bandCount);
    const Real oneMinus = 2 * (Real(sky.bandCount - 1 - entry) + left) / Real(sky.bandCount);
    const Real cosine = oneMinus < 1 ? 1 - oneMinus : onePlus - 1, sine = std::sqrt(onePlus * oneMinus);
    const Vec2<Real> turn = sinCosTurn(u.y);
    const Frame<Real> frame = frameFromNormal(glm::normalize(Vec3<Real>(sky.axis)));
    const Vec3<Real> direction = glm::normalize(toWorld(frame, Vec3<Real>{sine * turn.y, sine * turn.x, cosine}));
    return {direction, findStar(scene, direction)};
}

}  // namespace parhelion::reference
