#pragma once

#include <cmath>
#include <vector>

#include "compile/compiled_scene.h"
#include "scene/scene_description.h"
#include "support/stress.h"

namespace parhelion::test {

/// The formula of the sky's gradient, written down once more: what renderers are held against.
inline glm::dvec3 gradientFormula(const SkyDescription& sky, double tRaw) {
    const double above = tRaw + sky.offset - 0.5;
    const double s = sky.width == 0 ? (above >= 0 ? 1.0 : 0.0) : std::clamp(above / sky.width + 0.5, 0.0, 1.0);
    const double t = std::pow(s, sky.power);
    return (1 - t) * sky.bottom + t * sky.top;
}

/// (d.axis + 1) / 2 of unit vectors, in double.
inline double rawHeight(const SkyDescription& sky, const glm::dvec3& direction) {
    return 0.5 + 0.5 * glm::dot(glm::normalize(direction), glm::normalize(glm::dvec3(glm::vec3(sky.axis))));
}

/// A tilted sky with every term of the formula, and some 500 stars.
inline SkyDescription starrySky(double starSizeDegrees = 2.0) {
    SkyDescription sky;
    sky.axis = glm::normalize(glm::dvec3(0.3, 1, -0.2));
    sky.offset = -0.05;
    sky.width = 0.75;
    sky.power = 1.5;
    sky.bottom = {1, 0.5, 0.25};
    sky.top = {0.1, 0.3, 0.9};
    sky.starDensity = 40;
    sky.starSizeDegrees = starSizeDegrees;
    sky.starRadiance = {20, 25, 30};
    sky.starSeed = 7;
    return sky;
}

/// Directions about a star's rim: `share` is the chord as a share of the disc's.
inline glm::vec3 besideStar(const glm::vec4& disc, double share, double turn) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(glm::vec3(disc)));
    const glm::dvec3 u = glm::normalize(glm::cross(d, std::abs(d.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const double chord = share * std::sqrt(2.0 * disc.w);
    return glm::vec3(glm::normalize(d * std::sqrt(1 - chord * chord) +
                                    chord * (std::cos(turn) * u + std::sin(turn) * glm::cross(d, u))));
}

/// Random directions, directions next to the borders of the lookup's cells and faces, and about the rims of stars.
inline std::vector<glm::vec3> skyDirections(const CompiledScene& scene, std::size_t random) {
    std::vector<glm::vec3> directions = stressDirections(random);
    Stress stress(61);
    const auto cells = float(std::max(scene.constants.sky.starCells, 1u));
    for (std::size_t i = 0; i < random; ++i) {
        const float border = 2 * std::floor(stress.between(0, 1) * (cells + 1)) / cells - 1;
        glm::vec3 d{1, border * (1 + stress.between(-2e-7f, 2e-7f)), stress.between(-1, 1)};
        if (i % 2 == 1) std::swap(d.y, d.z);
        for (std::size_t turn = i % 3; turn > 0; --turn) d = {d.z, d.x, d.y};
        directions.push_back(glm::normalize(i % 5 < 2 ? -d : d));
    }
    for (std::size_t star = 0; star < scene.stars.size(); star += 2)
        for (const double share : {0.0, 0.3, 0.9, 0.999, 1.001, 1.1, 2.0})
            directions.push_back(besideStar(scene.stars[star], share, stress.between(0, 6.2831853f)));
    return directions;
}

}  // namespace parhelion::test
