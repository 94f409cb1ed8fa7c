#include "volume/density_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace parhelion {
namespace {

std::size_t denseIndex(glm::uvec3 voxel, glm::uvec3 resolution) {
    return (std::size_t(voxel.z) * resolution.y + voxel.y) * resolution.x + voxel.x;
}

std::vector<float> randomValues(glm::uvec3 resolution, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> values(std::size_t(resolution.x) * resolution.y * resolution.z);
    for (float& value : values) value = static_cast<float>(random() >> 8) * 0x1p-24f;
    return values;
}

/// Trilinear interpolation from its definition: hat functions about every voxel centre, on a clamped point.
double interpolateBruteForce(glm::uvec3 resolution, const std::vector<float>& values, glm::dvec3 p) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) p[axis] = std::clamp(p[axis], 0.5, resolution[axis] - 0.5);
    for (unsigned z = 0; z < resolution.z; ++z) {
        for (unsigned y = 0; y < resolution.y; ++y) {
            for (unsigned x = 0; x < resolution.x; ++x) {
                const glm::dvec3 hat = 1.0 - glm::abs(p - (glm::dvec3(x, y, z) + 0.5));
                if (hat.x > 0 && hat.y > 0 && hat.z > 0)
                    sum += hat.x * hat.y * hat.z * values[denseIndex({x, y, z}, resolution)];
            }
        }
    }
    return sum;
}

// Weights and their products round 12 times on values <= 1, the hat functions a few times more at |p| <= 32.
constexpr double kInterpolationTolerance = 64 * 0x1p-53 * 32;

const std::vector<glm::uvec3> kShapes{{1, 1, 1}, {1, 9, 17}, {9, 1, 8}, {17, 8, 1}, {13, 10, 11}, {8, 8, 8}};

TEST(DensityGrid, KeepsDenseValuesBitExactly) {
    for (const glm::uvec3 resolution : kShapes) {
        const std::vector<float> values = randomValues(resolution, 1);
        EXPECT_EQ(DensityGrid::fromDense(resolution, values).toDense(), values);
    }
}

TEST(DensityGrid, AgreesWithDenseValuesAtEveryVoxel) {
    const glm::uvec3 resolution(13, 10, 11);
    const std::vector<float> values = randomValues(resolution, 2);
    const DensityGrid grid = DensityGrid::fromDense(resolution, values);
    for (unsigned z = 0; z < resolution.z; ++z)
        for (unsigned y = 0; y < resolution.y; ++y)
            for (unsigned x = 0; x < resolution.x; ++x)
                ASSERT_EQ(grid.at({x, y, z}), values[denseIndex({x, y, z}, resolution)]);
}

TEST(DensityGrid, TablePointsToBricksXFastest) {
    const glm::uvec3 resolution(13, 10, 11);
    const std::vector<float> values = randomValues(resolution, 3);
    const DensityGrid grid = DensityGrid::fromDense(resolution, values);
    ASSERT_EQ(grid.brickCounts(), glm::uvec3(2, 2, 2));
    ASSERT_EQ(grid.brickTable().size(), 8u);
    // Voxel (12, 9, 10) lies in brick (1, 1, 1) at (4, 1, 2).
    const std::uint32_t brick = grid.brickTable()[7];
    EXPECT_EQ(grid.voxels()[brick * 512 + (2 * 8 + 1) * 8 + 4], values[denseIndex({12, 9, 10}, resolution)]);
}

TEST(DensityGrid, DropsBricksOfZeros) {
    const glm::uvec3 resolution(24, 16, 9);
    std::vector<float> values(24 * 16 * 9, 0.0f);
    values[denseIndex({23, 15, 8}, resolution)] = 2.0f;
    const DensityGrid grid = DensityGrid::fromDense(resolution, values);
    EXPECT_EQ(grid.voxels().size(), 512u);
    EXPECT_EQ(DensityGrid::countOccupiedBricks(resolution, values), 1u);
    EXPECT_EQ(std::ranges::count(grid.brickTable(), DensityGrid::kEmpty), 3 * 2 * 2 - 1);
    EXPECT_EQ(grid.toDense(), values);
    EXPECT_EQ(grid.maximum(), 2.0f);
}

TEST(DensityGrid, SetAllocatesForNonZeroValuesOnly) {
    DensityGrid grid({20, 20, 20});
    grid.set({3, 4, 5}, 0.0f);
    EXPECT_TRUE(grid.voxels().empty());
    EXPECT_EQ(grid.maximum(), 0.0f);
    grid.set({19, 0, 8}, 0.25f);
    EXPECT_EQ(grid.voxels().size(), 512u);
    EXPECT_EQ(grid.at({19, 0, 8}), 0.25f);
    EXPECT_EQ(grid.at({18, 0, 8}), 0.0f);
    grid.set({19, 0, 8}, 0.0f);
    EXPECT_EQ(grid.at({19, 0, 8}), 0.0f);
}

TEST(DensityGrid, InterpolatesAsBruteForceInsideAndClampedOutside) {
    std::mt19937 random(4);
    for (const glm::uvec3 resolution : kShapes) {
        const std::vector<float> values = randomValues(resolution, 5);
        const DensityGrid grid = DensityGrid::fromDense(resolution, values);
        std::uniform_real_distribution<double> unit(-0.25, 1.25);
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 p = glm::dvec3(unit(random), unit(random), unit(random)) * glm::dvec3(resolution);
            ASSERT_NEAR(grid.interpolate(p), interpolateBruteForce(resolution, values, p), kInterpolationTolerance)
                << "at " << p.x << ", " << p.y << ", " << p.z;
        }
    }
}

TEST(DensityGrid, InterpolationMeetsValuesAtCentresAndStaysConstantBeyondTheOutermost) {
    const glm::uvec3 resolution(13, 10, 11);
    const std::vector<float> values = randomValues(resolution, 6);
    const DensityGrid grid = DensityGrid::fromDense(resolution, values);
    EXPECT_EQ(grid.interpolate({4.5, 7.5, 2.5}), values[denseIndex({4, 7, 2}, resolution)]);
    const float first = values.front(), last = values.back();
    for (const glm::dvec3 p : {glm::dvec3(0.5), glm::dvec3(0.0), glm::dvec3(-1e9)})
        EXPECT_EQ(grid.interpolate(p), first);
    for (const glm::dvec3 p : {glm::dvec3(12.5, 9.5, 10.5), glm::dvec3(resolution), glm::dvec3(1e9)})
        EXPECT_EQ(grid.interpolate(p), last);
}

}  // namespace
}  // namespace parhelion
