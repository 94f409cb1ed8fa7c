#pragma once

#include <vector>

#include "volume/density_grid.h"

namespace parhelion {

/// Bounds of a density grid over cells of kVoxelsPerCell^3 voxels, for tracking to step through.
struct MajorantGrid {
    glm::uvec3 cells{0};
    std::vector<float> bounds;  ///< x fastest; [c] >= the interpolant anywhere in cell c
};

/// The interpolant in cell [8 c, 8 c + 8) reads voxels 8 c - 1 .. 8 c + 8 (clamped to the grid): the bound is their
/// maximum, widened by 1 + 2^-20 so that rounding in the interpolation stays below it. Zero stays zero.
///
/// Source: Szirmay-Kalos, Toth, Magdics 2011, "Free Path Sampling in High Resolution Inhomogeneous Participating
/// Media".
MajorantGrid buildMajorants(const DensityGrid& density);

}  // namespace parhelion
