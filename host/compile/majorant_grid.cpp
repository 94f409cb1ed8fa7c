#include "compile/majorant_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "shared/scene_types.h"

namespace parhelion {

namespace {

constexpr int kSize = int(DensityGrid::kBrickSize);
static_assert(shared::kVoxelsPerCell == DensityGrid::kBrickSize, "the smallest majorant cell is a brick");

/// Voxels of a brick that its neighbour at `offset` (-1, 0 or 1 an axis) reads: the layer next to it, or all.
struct VoxelRange {
    glm::ivec3 first{0}, last{kSize - 1};
};

VoxelRange rangeFacing(const glm::ivec3& offset) {
    VoxelRange range;
    for (int axis = 0; axis < 3; ++axis) {
        if (offset[axis] < 0) range.first[axis] = kSize - 1;
        if (offset[axis] > 0) range.last[axis] = 0;
    }
    return range;
}

float maximumOver(std::span<const float> voxels, const VoxelRange& range) {
    float result = 0.0f;
    for (int z = range.first.z; z <= range.last.z; ++z)
        for (int y = range.first.y; y <= range.last.y; ++y)
            for (int x = range.first.x; x <= range.last.x; ++x)
                result = std::max(result, voxels[(z * kSize + y) * kSize + x]);
    return result;
}

float widen(float bound) {
    const double exact = double(bound) * (1.0 + 0x1p-20);
    const float rounded = float(exact);
    return double(rounded) < exact ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded;
}

/// Padding beyond the resolution is zero and so never raises a bound.
float boundOf(const DensityGrid& density, const glm::ivec3& cell) {
    const glm::ivec3 counts(density.brickCounts());
    float bound = 0.0f;
    for (int dz = -1; dz <= 1; ++dz)
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const glm::ivec3 offset(dx, dy, dz), brick = cell + offset;
                if (glm::any(glm::lessThan(brick, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(brick, counts)))
                    continue;
                const std::span<const float> voxels = density.brick(glm::uvec3(brick));
                if (!voxels.empty()) bound = std::max(bound, maximumOver(voxels, rangeFacing(offset)));
            }
    return widen(bound);
}

}  // namespace

MajorantGrid buildMajorants(const DensityGrid& density) {
    MajorantGrid grid{density.brickCounts(), {}, 0};
    const glm::uvec3 cells = grid.cells;
    grid.bounds.resize(std::size_t(cells.x) * cells.y * cells.z);
    parallelFor(
        grid.bounds.size(),
        [&](std::size_t index) {
            const std::size_t row = index / cells.x;
            grid.bounds[index] = boundOf(density, glm::ivec3(index % cells.x, row % cells.y, row / cells.y));
        },
        64);
    return grid;
}

float MajorantGrid::at(const glm::dvec3& p) const {
    const glm::uvec3 c(glm::clamp(p / double(cellSize()), glm::dvec3(0.0), glm::dvec3(cells) - 0.5));
    return bounds[(std::size_t(c.z) * cells.y + c.y) * cells.x + c.x];
}

MajorantGrid coarsen(const MajorantGrid& fine) {
    MajorantGrid coarse{(fine.cells + 1u) / 2u, {}, fine.level + 1};
    coarse.bounds.assign(std::size_t(coarse.cells.x) * coarse.cells.y * coarse.cells.z, 0.0f);
    for (std::size_t i = 0; i < fine.bounds.size(); ++i) {
        const std::size_t row = i / fine.cells.x;
        const glm::uvec3 c = glm::uvec3(i % fine.cells.x, row % fine.cells.y, row / fine.cells.y) / 2u;
        float& bound = coarse.bounds[(std::size_t(c.z) * coarse.cells.y + c.y) * coarse.cells.x + c.x];
        bound = std::max(bound, fine.bounds[i]);
    }
    return coarse;
}

}  // namespace parhelion
