// From a description with procedural clouds to one with grids: mass, support, errors, refusals. Baked with the twin.
#include "compile/bake_clouds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "reference/cloud_baker.h"
#include "support/cloud_fields.h"
#include "unit/compile_fixtures.h"

namespace parhelion {
namespace {

using namespace fixtures;
using test::sweepField;

CloudBaker twin() { return {.bake = reference::bakeCloud<float>, .evaluate = reference::cloudDensityAt}; }

SceneDescription sceneWith(const shared::CloudField& field, const DensityGrid& base = {}) {
    SceneDescription description = scene();
    description.media.push_back(gridMedium("m", base));
    description.media[0].density->cloud = field;
    description.media[0].density->where = {"scene.xml", 4, 5};
    description.shapes.push_back(boundary(cube("box", {}, {1, 1, 1}), 0));
    return description;
}

double sumOf(const DensityGrid& grid) {
    const std::vector<float> values = grid.toDense();
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// A smooth ball of smoke, thin at its edge, with one denser voxel.
DensityGrid smoke(glm::uvec3 n) {
    std::vector<float> values;
    for (unsigned i = 0; i < n.x * n.y * n.z; ++i) {
        const glm::vec3 p = (glm::vec3(i % n.x, i / n.x % n.y, i / (n.x * n.y)) + 0.5f) / glm::vec3(n) - 0.5f;
        values.push_back(3 * std::max(0.0f, 1 - 5 * glm::dot(p, p)));
    }
    values[values.size() / 2] = 4;
    return DensityGrid::fromDense(n, values);
}

shared::CloudField modulating(float detail, glm::uvec3 resolution) {
    shared::CloudField field = sweepField(detail, 1);
    field.modulates = 1;
    field.densityThreshold = 0;
    field.resolution = resolution;
    return field;
}

TEST(BakedCloud, BecomesTheGridOfItsMedium) {
    SceneDescription description = sceneWith(sweepField(0.38f, 32));
    const auto reports = bakeClouds(description, twin());
    ASSERT_EQ(reports.size(), 1u);
    EXPECT_EQ(reports[0].where, "scene.xml:4:5");
    EXPECT_FALSE(reports[0].error.has_value());
    EXPECT_FALSE(description.media[0].density->cloud.has_value());
    const DensityGrid& grid = description.media[0].density->volume.density;
    EXPECT_EQ(grid.toDense(), reference::bakeCloud<float>(sweepField(0.38f, 32), {}, 0));
    EXPECT_EQ(compileScene(description).constants.media[0].resolution, glm::uvec3(32));
    EXPECT_TRUE(bakeClouds(description, twin()).empty());  // nothing is left to bake
}

TEST(BakedCloud, ThresholdLeavesBricksEmpty) {
    SceneDescription description = sceneWith(sweepField(0.62f, 64));
    const auto reports = bakeClouds(description, twin());
    const auto table = description.media[0].density->volume.density.brickTable();
    EXPECT_GT(std::ranges::count(table, DensityGrid::kEmpty), 64);  // of 512
    EXPECT_LT(reports[0].occupancy, 0.5);
}

TEST(BakedCloud, UnbakedIsRefusedByCompileScene) {
    try {
        compileScene(sceneWith(sweepField(0.62f, 16)));
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.where().text(), "scene.xml:4:5");
        EXPECT_NE(std::string(error.what()).find("must be baked"), std::string::npos);
    }
}

TEST(BakedCloud, CutAtItsBoxIsNoted) {
    SceneDescription inside = sceneWith(sweepField(0.38f, 32)), cut = sceneWith(sweepField(0, 32));
    cut.media[0].density->cloud->surfaceWidth = 1;  // as soft as the cube is large
    bakeClouds(inside, twin());
    bakeClouds(cut, twin());
    EXPECT_TRUE(inside.notes.empty());
    ASSERT_EQ(cut.notes.size(), 1u);
    EXPECT_NE(cut.notes[0].find("scene.xml:4:5: the cloud reaches the sides"), std::string::npos) << cut.notes[0];
}

TEST(BakedCloud, MoreMemoryThanAllowedIsRefused) {
    SceneDescription description = sceneWith(sweepField(0.62f, 512));
    try {
        bakeClouds(description, twin(), {.memoryLimitBytes = std::size_t{1} << 29});
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.where().text(), "scene.xml:4:5");
        EXPECT_NE(std::string(error.what()).find("needs 1024 MiB; allowed are 512 MiB"), std::string::npos)
            << error.what();
    }
}

// Without threshold the density is continuous, with a continuous slope except on the ridges between the cells' points:
// a step h leaves errors h^2, and on the ridges h on a share h of the voxels, h^1.5 (rms): between 2^1.5 = 2.8 and 4
// for half of it. With the threshold's jump of 0.02 it is h^0.5, 1.4: the test tells them apart.
TEST(BakeError, ShrinksWithTheSquareOfTheVoxelAwayFromTheThreshold) {
    const auto errorOf = [](shared::CloudField field, unsigned resolution, float threshold) {
        field.noiseScale = 1;
        field.erosionAmount = 0;
        field.densityThreshold = threshold;
        field.resolution = glm::uvec3(resolution);
        SceneDescription description = sceneWith(field);
        return *bakeClouds(description, twin(), {.measureError = true})[0].error;
    };
    for (const float detail : {0.0f, 0.3f}) {
        const shared::CloudField field = sweepField(detail, 1);
        const CloudBakeError coarse = errorOf(field, 32, 0), fine = errorOf(field, 64, 0);
        EXPECT_GT(coarse.fieldRms / fine.fieldRms, detail > 0 ? 2.8 : 3.5) << detail;
        EXPECT_LT(coarse.fieldRms / fine.fieldRms, 4.5) << detail;
        EXPECT_GT(coarse.doubledRms / fine.doubledRms, detail > 0 ? 2.8 : 3.5) << detail;
        EXPECT_LE(coarse.doubledRms, coarse.doubledMaximum);
        EXPECT_EQ(coarse.points, 65536u);
    }
    EXPECT_LT(errorOf(sweepField(0, 1), 32, 0.3f).fieldRms / errorOf(sweepField(0, 1), 64, 0.3f).fieldRms, 2.2);
}

// Sums round 2^-24 of each value at random; the factor stops at 1e-9.
TEST(ModulatedCloud, KeepsMassSupportAndLargestDensity) {
    const glm::uvec3 n(24, 40, 17);
    const DensityGrid base = smoke(n);
    double last = 0;
    for (const float detail : {0.2f, 0.4f, 0.62f, 0.85f}) {
        SceneDescription description = sceneWith(modulating(detail, n), base);
        const auto reports = bakeClouds(description, twin(), {.measureError = detail == 0.62f});
        const DensityGrid& grid = description.media[0].density->volume.density;
        EXPECT_NEAR(sumOf(grid) / sumOf(base), 1, 1e-6);
        EXPECT_NEAR(reports[0].massRatio, 1, 1e-6);
        EXPECT_LE(grid.maximum(), base.maximum());
        const std::vector<float> before = base.toDense(), after = grid.toDense();
        double changed = 0;
        for (std::size_t i = 0; i < before.size(); ++i) {
            ASSERT_EQ(after[i] > 0, before[i] > 0) << i;
            changed += std::abs(after[i] - before[i]);
        }
        EXPECT_GT(changed, last * 1.2);  // more detail, more change
        last = changed;
    }
    EXPECT_GT(last, 0.2 * sumOf(base));
}

TEST(ModulatedCloud, WithoutDetailIsTheDensityItself) {
    const DensityGrid base = smoke({16, 16, 16});
    SceneDescription description = sceneWith(modulating(0, {16, 16, 16}), base);
    bakeClouds(description, twin());
    EXPECT_EQ(description.media[0].density->volume.density.toDense(), base.toDense());
}

// A finer grid than the density's: what was empty between voxels stays so, the mass is that of the finer voxels.
TEST(ModulatedCloud, RefinesACoarseDensity) {
    const DensityGrid base = smoke({12, 12, 12});
    SceneDescription description = sceneWith(modulating(0.62f, {48, 48, 48}), base);
    bakeClouds(description, twin());
    const DensityGrid& grid = description.media[0].density->volume.density;
    EXPECT_EQ(grid.resolution(), glm::uvec3(48));
    // The interpolant's mean differs from the voxels' only by what is clamped at the sides, where this ball has
    // nothing.
    EXPECT_NEAR(sumOf(grid) / 64, sumOf(base), 1e-5 * sumOf(base));
    for (unsigned i = 0; i < 48 * 48 * 48; ++i) {
        const glm::uvec3 voxel(i % 48, i / 48 % 48, i / (48 * 48));
        const double before = base.interpolate((glm::dvec3(voxel) + 0.5) / 4.0);
        ASSERT_EQ(grid.at(voxel) > 0, float(before) > 0) << i;
    }
}

TEST(RestoreMass, StopsAtTheLargestDensity) {
    std::vector<float> values{0, 0.5f, 1, 2};
    const auto [factor, reached] = restoreMass(values, 6, 2.5f);
    // 2 and 1 reach 2.5 at different factors: 0.5 f + 1 f + 2.5 = 6 gives f = 7 / 3.
    EXPECT_NEAR(factor, 7.0 / 3, 1e-8);
    EXPECT_NEAR(reached, 6, 1e-8);
    EXPECT_EQ(values, (std::vector<float>{0, float(factor * 0.5), float(factor), 2.5f}));
    std::vector<float> full{0, 1, 1};
    EXPECT_EQ(restoreMass(full, 9, 1).second, 2);  // out of reach
    EXPECT_EQ(full, (std::vector<float>{0, 1, 1}));
}

}  // namespace
}  // namespace parhelion
