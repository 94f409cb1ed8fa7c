#pragma once

#include "reference/core/scene.h"
#include "reference/sampling/distribution.h"
#include "reference/sampling/sampler.h"

namespace parhelion::reference {

/// Where a direction meets the map: between which texels, and how far from the first.
template <typename Real>
struct EnvironmentPlace {
    std::uint32_t column, row;
    Vec2<Real> fraction;
};

template <typename Real>
EnvironmentPlace<Real> environmentPlace(const SceneView<Real>& scene, const Vec3<Real>& d) {
    const shared::EnvironmentMap& map = scene.constants.environmentMap;
    const auto coordinate = [&](const glm::vec3& axis) { return glm::dot(Vec3<Real>(axis), d); };
    const Real x = coordinate(map.localX), y = coordinate(map.localY), z = coordinate(map.localZ);
    const Real u = angleOf(x, -z) / (2 * kPi<Real>)*Real(map.width) - Real(0.5);
    const Real v = angleOf(std::hypot(x, z), y) / kPi<Real> * Real(map.height - 1);
    const Real column = std::floor(u), row = std::min(std::floor(v), Real(map.height - 2));
    const auto wrapped = std::int64_t(column) < 0 ? std::int64_t(column) + map.width : std::int64_t(column);
    return {std::uint32_t(wrapped), std::uint32_t(row), {u - column, std::min(v - row, Real(1))}};
}

/// What comes from a direction, and the density per steradian with which sampleEnvironment finds it.
template <typename Real>
struct EnvironmentLight {
    Vec3<Real> radiance;
    Real pdf;
};

template <typename Real>
EnvironmentLight<Real> environmentAt(const SceneView<Real>& scene, const Vec3<Real>& d) {
    const std::uint32_t width = scene.constants.environmentMap.width;
    const EnvironmentPlace<Real> place = environmentPlace(scene, d);
    const auto texel = [&](std::uint32_t column, std::uint32_t row) {
        return scene.source.environmentTexels[std::size_t(row) * width + column % width];
    };
    Vec3<Real> radiance(0);
    for (std::uint32_t j = 0; j < 2; ++j)
        for (std::uint32_t i = 0; i < 2; ++i) {
            const Real weight =
                (i ? place.fraction.x : 1 - place.fraction.x) * (j ? place.fraction.y : 1 - place.fraction.y);
            radiance += weight * Vec3<Real>(texel(place.column + i, place.row + j));
        }
    return {radiance, Real(texel(place.column, place.row).w)};
}

/// A direction, and its density per steradian: of the cell it was taken from.
template <typename Real>
struct EnvironmentSample {
    Vec3<Real> direction;
    Real pdf;
};

/// @param words  x, y and z of a light draw.
template <typename Real>
EnvironmentSample<Real> sampleEnvironment(const SceneView<Real>& scene, const glm::uvec3& words) {
    const shared::EnvironmentMap& map = scene.constants.environmentMap;
    const auto tables = std::span(scene.source.distributions).subspan(map.distribution);
    const Vec2<Real> fill = fillDigits<Real>(words.z);
    const auto [row, down, up] = invertDistribution(tables.first(map.height), words.x, fill.x);
    const auto cells = tables.subspan(map.height + std::size_t(row) * (map.width + 1), map.width + 1);
    const auto [column, along, _] = invertDistribution(cells, words.y, fill.y);
    const glm::vec2& edge = scene.source.environmentRows[row];
    const bool isNorth = row < map.height / 2;
    const Real fromPole = Real(edge.x) + (isNorth ? down : up) * Real(edge.y);
    const Real cosine = isNorth ? 1 - fromPole : fromPole - 1;
    const Real sine = std::sqrt(fromPole * (2 - fromPole));
    const Real turn = (Real(column) + Real(0.5) + along) / Real(map.width);
    const Vec2<Real> sc = sinCosTurn(turn - std::floor(turn));
    const Vec3<Real> direction =
        sine * sc.x * Vec3<Real>(map.localX) + cosine * Vec3<Real>(map.localY) - sine * sc.y * Vec3<Real>(map.localZ);
    return {glm::normalize(direction), Real(scene.source.environmentTexels[std::size_t(row) * map.width + column].w)};
}

}  // namespace parhelion::reference
