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
/// uniform over the sphere, those that would touch an earlier one placed anew. A disc of radius r keeps others' centers
/// from 4 sin^2(r/2) of the sphere at most, four times what it covers: where all together cover a tenth of it, as
/// scenes may at most, a place is free with probability 0.6 or more. Brightness b follows N(> b) ~ b^-3/2, what a
/// uniform space of equal suns shows, from kFaintestStar to 1. Neighbours in the list are near each other in the sky.
///
/// @return at most kMaxStars.
/// @throws InputError at `where` when 4 attempts a star and 1000 more have not found room: they would cover too much.
std::vector<Star> scatterStars(const SkyDescription& sky, const SourceLocation& where = {});

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
