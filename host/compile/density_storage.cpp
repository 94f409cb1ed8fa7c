#include "compile/density_storage.h"

#include <algorithm>

namespace parhelion {

namespace {

constexpr std::size_t kMiB = std::size_t(1) << 20;
constexpr std::size_t kSparseFromBytes = 64 * kMiB;  // smaller grids are not worth the second look-up
constexpr double kSparseOccupancy = 0.6;             // of the bricks

std::size_t voxelCount(const DensityGrid& grid) {
    const glm::uvec3 n = grid.resolution();
    return std::size_t(n.x) * n.y * n.z;
}

bool wantsBricks(const DensityGrid& grid) {
    const std::size_t denseBytes = sizeof(float) * voxelCount(grid);
    const double occupied = double(grid.voxels().size()) / DensityGrid::kBrickVoxels;
    const bool sparse = occupied < kSparseOccupancy * double(grid.brickTable().size());
    return denseBytes > kSparseFromBytes && sparse;
}

}  // namespace

DensityPlan planDensityStorage(std::span<const DensityGrid* const> grids) {
    DensityPlan plan;
    std::size_t denseVoxels = 0;
    for (const DensityGrid* grid : grids) denseVoxels += voxelCount(*grid);
    plan.bricked =
        denseVoxels > kMaxTexels || std::ranges::any_of(grids, [](const auto* g) { return wantsBricks(*g); });
    for (const DensityGrid* grid : grids) {
        plan.voxels += plan.bricked ? grid->voxels().size() : voxelCount(*grid);
        plan.tableEntries += plan.bricked ? grid->brickTable().size() : 0;
    }
    return plan;
}

std::uint32_t appendDensity(const DensityGrid& grid, bool bricked, CompiledScene& scene) {
    const auto firstVoxel = std::uint32_t(scene.density.size());
    if (!bricked) {
        const std::vector<float> dense = grid.toDense();
        scene.density.insert(scene.density.end(), dense.begin(), dense.end());
        return firstVoxel;
    }
    const auto firstEntry = std::uint32_t(scene.brickTable.size());
    for (const std::uint32_t brick : grid.brickTable())
        scene.brickTable.push_back(brick == DensityGrid::kEmpty ? shared::kEmptyBrick
                                                                : firstVoxel + brick * DensityGrid::kBrickVoxels);
    scene.density.insert(scene.density.end(), grid.voxels().begin(), grid.voxels().end());
    return firstEntry;
}

}  // namespace parhelion
