#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "volume/density_grid.h"
#include "volume/sparse_volume.h"

namespace parhelion {

constexpr unsigned kVdbLowerEdge = 128;   ///< voxels along a node above leaves
constexpr unsigned kVdbUpperEdge = 4096;  ///< voxels along a node below the root

/// A leaf of the fog volume that a density is written as: voxel (i, j, k) has index (i, j, k), non-zero voxels are
/// active, and so are, as zeros, the first and the last one: the box of active voxels is what states the resolution.
struct VdbLeaf {
    glm::uvec3 origin;                      ///< index of its first voxel
    std::array<std::uint64_t, 8> active{};  ///< a bit for each voxel, z fastest
    std::vector<float> values;              ///< of the active voxels, z fastest
};

/// The leaves in the order in which trees hold them: by upper node, then by lower node, z fastest in each.
std::vector<VdbLeaf> vdbLeaves(const DensityGrid& density);

/// Where the voxels lie in the world.
struct VdbPlacement {
    glm::dvec3 voxelSize;
    glm::dvec3 firstCentre;  ///< of voxel (0, 0, 0)
};
VdbPlacement vdbPlacement(const Volume& volume);

}  // namespace parhelion
