#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/scene_description.h"

namespace parhelion {

/// A disc of constant radiance on the sphere of directions.
struct Star {
    glm::vec3 direction;  ///< unit, rounded: the disc is about exactly this direction
    double brightness;    ///< in [kFaintestStar, 1]
};

inline constexpr double kFaintestStar = 0.02;

/// The stars of a sky, the same for the same density, size and seed: as many as a Poisson process of that density has,
/// uniform over the sphere, those that would touch an earlier one placed anew. Brightness b follows
/// N(> b) ~ b^-3/2, what a uniform space of equal suns shows, from kFaintestStar to 1.
///
/// @return at most kMaxStars.
std::vector<Star> scatterStars(const SkyDescription& sky);

/// 1 - cos of the stars' angular radius.
double starOneMinusCos(const SkyDescription& sky);

/// The cube map of shaders/README.md, "Sky", as coarse as it can be with at most kMaxStarsPerCell stars a cell.
///
/// A star is listed in every cell that its disc may reach, by bounds 1e-6 wider than the disc: whatever a back end's
/// rounding, it finds every star that covers a direction.
struct StarGrid {
    std::uint32_t cellsPerEdge = 0;
    std::vector<std::uint32_t> words;
};
StarGrid buildStarGrid(std::span<const Star> stars, double oneMinusCos);

}  // namespace parhelion
