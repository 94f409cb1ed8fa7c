#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "compile/majorant_grid.h"
#include "shared/scene_types.h"

// Covers H17 (bounds below the density darken or brighten silently), H22 and H23 of the list of hard cases.
namespace parhelion {
namespace {

constexpr int kPoints = 100'000;

double uniform(std::mt19937& random) { return double(random() >> 5) * 0x1p-27; }

DensityGrid noise(glm::uvec3 n) {
    std::mt19937 random(5);
    std::vector<float> values(std::size_t(n.x) * n.y * n.z);
    // Mostly empty with high peaks: what a missing halo gets wrong.
    for (float& value : values) value = random() % 4 == 0 ? float(std::pow(uniform(random), 8.0)) : 0.0f;
    values[values.size() / 2] = 1.0f;
    return DensityGrid::fromDense(n, values);
}

/// Uniform points, points within a voxel of cell faces, points on and outside the border, and voxel centres (where
/// the interpolant has its maxima).
glm::dvec3 samplePoint(std::mt19937& random, glm::uvec3 n, int kind) {
    glm::dvec3 p;
    for (int axis = 0; axis < 3; ++axis) {
        const double u = uniform(random);
        const double faces = n[axis] / shared::kVoxelsPerCell + 1;
        if (kind % 4 == 0) p[axis] = u * n[axis];
        if (kind % 4 == 1) p[axis] = std::floor(uniform(random) * faces) * shared::kVoxelsPerCell + 2.0 * u - 1.0;
        if (kind % 4 == 3) p[axis] = std::floor(u * n[axis]) + 0.5;
        if (kind % 4 == 2) p[axis] = u < 0.3 ? 0.0 : u < 0.6 ? double(n[axis]) : -2.0 + u * (n[axis] + 4.0);
    }
    return p;
}

int violations(const DensityGrid& grid, const MajorantGrid& majorants) {
    std::mt19937 random(6);
    int count = 0;
    for (int i = 0; i < kPoints; ++i) {
        const glm::dvec3 p = samplePoint(random, grid.resolution(), i);
        count += grid.interpolate(p) > majorants.at(p);
    }
    return count;
}

std::vector<glm::uvec3> resolutions() {
    return {{1, 1, 1}, {1, 9, 17}, {7, 8, 9}, {16, 16, 16}, {33, 20, 41}, {64, 3, 8}};
}

TEST(MajorantBounds, HoldTheInterpolantEverywhere) {
    for (const glm::uvec3 n : resolutions()) {
        const DensityGrid grid = noise(n);
        const MajorantGrid majorants = buildMajorants(grid);
        EXPECT_EQ(majorants.cells, (n + 7u) / 8u);
        EXPECT_EQ(violations(grid, majorants), 0) << n.x << " x " << n.y << " x " << n.z;
    }
}

TEST(MajorantBounds, HoldTheInterpolantInCoarserCells) {
    for (const glm::uvec3 n : resolutions()) {
        const DensityGrid grid = noise(n);
        for (MajorantGrid majorants = buildMajorants(grid); majorants.bounds.size() > 1;) {
            majorants = coarsen(majorants);
            EXPECT_EQ(majorants.cells, (n + majorants.cellSize() - 1u) / majorants.cellSize());
            EXPECT_EQ(violations(grid, majorants), 0) << n.x << " x " << n.y << " x " << n.z << ", " << majorants.level;
        }
    }
    const DensityGrid grid = noise({33, 20, 41});
    MajorantGrid shifted = coarsen(buildMajorants(grid));
    std::rotate(shifted.bounds.begin(), shifted.bounds.begin() + 1, shifted.bounds.end());
    EXPECT_GT(violations(grid, shifted), 0) << "the bounds of other cells";
}

TEST(MajorantBounds, SeededDefectsAreCaught) {
    const DensityGrid grid = noise({33, 20, 41});
    MajorantGrid lowered = buildMajorants(grid);
    for (float& bound : lowered.bounds) bound *= 0.9f;
    EXPECT_GT(violations(grid, lowered), 0) << "bounds a tenth too low";

    // Without the halo: the maximum over the cell's own voxels.
    MajorantGrid bare = buildMajorants(grid);
    std::fill(bare.bounds.begin(), bare.bounds.end(), 0.0f);
    const glm::uvec3 n = grid.resolution();
    for (unsigned z = 0; z < n.z; ++z)
        for (unsigned y = 0; y < n.y; ++y)
            for (unsigned x = 0; x < n.x; ++x) {
                float& bound = bare.bounds[(std::size_t(z / 8) * bare.cells.y + y / 8) * bare.cells.x + x / 8];
                bound = std::max(bound, grid.at({x, y, z}));
            }
    EXPECT_GT(violations(grid, bare), 0) << "no halo";
}

TEST(MajorantBounds, AreTheLargestVoxelReadAndNoMore) {
    // First principles: the largest of voxels 8 c - 1 .. 8 c + 8, clamped, times 1 + 2^-20 and one rounding.
    const glm::uvec3 n(33, 20, 41);
    const DensityGrid grid = noise(n);
    const MajorantGrid majorants = buildMajorants(grid);
    const glm::ivec3 last = glm::ivec3(n) - 1;
    for (unsigned c = 0; c < majorants.bounds.size(); ++c) {
        const glm::ivec3 cell(c % majorants.cells.x, c / majorants.cells.x % majorants.cells.y,
                              c / (majorants.cells.x * majorants.cells.y));
        const glm::ivec3 low = glm::max(8 * cell - 1, glm::ivec3(0)), high = glm::min(8 * cell + 8, last);
        double largest = 0.0;
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x) largest = std::max(largest, double(grid.at(glm::uvec3(x, y, z))));
        EXPECT_GE(majorants.bounds[c], largest * (1 + 0x1p-20));
        EXPECT_LE(majorants.bounds[c], largest * (1 + 0x1p-20) * (1 + 0x1p-22));
    }
}

TEST(MajorantBounds, StayZeroWhereNothingIsRead) {
    DensityGrid grid({40, 40, 40});
    grid.set({16, 20, 20}, 1.0f);  // the first voxel of cell 2 along x: cell 1 reads it, cell 0 and 3 do not
    const MajorantGrid majorants = buildMajorants(grid);
    const auto at = [&](unsigned x) { return majorants.bounds[(2 * 5 + 2) * 5 + x]; };
    EXPECT_EQ(at(0), 0.0f);
    EXPECT_GT(at(1), 1.0f);
    EXPECT_GT(at(2), 1.0f);
    EXPECT_EQ(at(3), 0.0f);
}

}  // namespace
}  // namespace parhelion
