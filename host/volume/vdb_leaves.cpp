#include "volume/vdb_leaves.h"

#include <algorithm>
#include <tuple>

namespace parhelion {

namespace {

/// Voxel `index` of a leaf, z fastest.
glm::uvec3 voxelInLeaf(unsigned index) { return {index / 64, index / 8 % 8, index % 8}; }

VdbLeaf makeLeaf(const DensityGrid& density, glm::uvec3 brick) {
    const glm::uvec3 last = density.resolution() - 1u;
    const std::span<const float> values = density.brick(brick);
    VdbLeaf leaf;
    leaf.origin = brick * kLeafEdge;
    for (unsigned i = 0; i < kLeafVoxels; ++i) {
        const glm::uvec3 p = voxelInLeaf(i), voxel = leaf.origin + p;
        const float value = values.empty() ? 0.0f : values[(p.z * 8 + p.y) * 8 + p.x];
        if (value == 0.0f && voxel != glm::uvec3(0) && voxel != last) continue;
        leaf.active[i / 64] |= std::uint64_t(1) << (i % 64);
        leaf.values.push_back(value);
    }
    return leaf;
}

auto treeOrder(const VdbLeaf& leaf) {
    const glm::uvec3 upper = leaf.origin / kVdbUpperEdge, lower = leaf.origin / kVdbLowerEdge, p = leaf.origin;
    return std::tuple(upper.x, upper.y, upper.z, lower.x, lower.y, lower.z, p.x, p.y, p.z);
}

}  // namespace

std::vector<VdbLeaf> vdbLeaves(const DensityGrid& density) {
    std::vector<VdbLeaf> leaves;
    const glm::uvec3 lastBrick = density.brickCounts() - 1u;
    for (std::size_t index = 0; index < density.brickTable().size(); ++index) {
        const glm::uvec3 brick = density.brickAt(index);
        if (!density.brick(brick).empty() || brick == glm::uvec3(0) || brick == lastBrick)
            leaves.push_back(makeLeaf(density, brick));
    }
    std::ranges::sort(leaves, {}, treeOrder);
    return leaves;
}

VdbPlacement vdbPlacement(const Volume& volume) {
    const glm::dvec3 size = (volume.boundsMax - volume.boundsMin) / glm::dvec3(volume.density.resolution());
    return {size, volume.boundsMin + 0.5 * size};
}

}  // namespace parhelion
