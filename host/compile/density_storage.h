#pragma once

#include <cstddef>
#include <span>

#include "compile/compiled_scene.h"
#include "volume/density_grid.h"

namespace parhelion {

/// Whether to keep these grids as bricks, and what that takes.
struct DensityPlan {
    bool bricked = false;
    std::size_t voxels = 0;        ///< values stored in `density`
    std::size_t tableEntries = 0;  ///< values stored in `brickTable`

    std::size_t bytes() const { return 4 * (voxels + tableEntries); }
};

DensityPlan planDensityStorage(std::span<const DensityGrid* const> grids);

/// Appends a grid's voxels in the planned form.
/// @return Medium.voxelOffset: the first voxel (dense) or the first brick table entry.
std::uint32_t appendDensity(const DensityGrid& grid, bool bricked, CompiledScene& scene);

}  // namespace parhelion
