#pragma once

#include <vector>

#include "volume/density_grid.h"

namespace parhelion {

/// Bounds of a density grid over cubes of cellSize() voxels, for tracking to step through.
struct MajorantGrid {
    glm::uvec3 cells{0};
    std::vector<float> bounds;  ///< x fastest; [c] >= the interpolant anywhere in cell c
    unsigned level = 0;         ///< cells span 8 * 2^level voxels an axis

    unsigned cellSize() const { return DensityGrid::kBrickSize << level; }
    /// Bound of the cell that holds voxel position p in [0, resolution]^3.
    float at(const glm::dvec3& p) const;
};

/// The interpolant in cell [8 c, 8 c + 8) reads voxels 8 c - 1 .. 8 c + 8 (clamped to the grid): the bound is their
/// maximum, widened by 1 + 2^-20 so that rounding in the interpolation stays below it. Zero stays zero.
///
/// Source: Szirmay-Kalos, Toth, Magdics 2011, "Free Path Sampling in High Resolution Inhomogeneous Participating
/// Media".
MajorantGrid buildMajorants(const DensityGrid& density);

/// The same bounds over cells of twice the size: the largest of the up to eight that each new cell holds.
MajorantGrid coarsen(const MajorantGrid& fine);

/// The level at which tracking takes the fewest steps. A step is a tentative collision or a change of cells: fine cells
/// have few of the former, coarse ones few of the latter. Both are summed along 512 rays that start in the grid, half
/// of their weight where the density is, each step in proportion to the light that gets there.
///
/// @param depthPerVoxel  extinction at density 1 times the length of a voxel's edge, per axis.
MajorantGrid chooseMajorants(const DensityGrid& density, const glm::dvec3& depthPerVoxel);

}  // namespace parhelion
