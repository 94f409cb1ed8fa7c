#include "compile/compile_media.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compile/density_storage.h"
#include "unit/compile_fixtures.h"

namespace parhelion {
namespace {

using namespace fixtures;

SceneDescription sceneWith(std::vector<MediumDescription> media) {
    SceneDescription description = scene();
    for (std::size_t i = 0; i < media.size(); ++i)
        description.shapes.push_back(boundary(cube("box", {4.0 * double(i), 0, 0}, {1, 1, 1}), i));
    description.media = std::move(media);
    return description;
}

/// Values 1, 2, 3, ... in x-fastest order, scaled.
DensityGrid counting(glm::uvec3 n) {
    std::vector<float> values(n.x * n.y * n.z);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i + 1) / float(values.size());
    return DensityGrid::fromDense(n, values);
}

TEST(CompiledMedia, SplitsExtinctionIntoLargestAndRatio) {
    MediumDescription chromatic = medium("m");
    chromatic.sigmaT = {1, 4, 2};
    chromatic.albedo = {0.25, 0.5, 1.0};
    const CompiledScene compiled = compileScene(sceneWith({chromatic}));
    const shared::Medium& record = compiled.constants.media[0];
    EXPECT_EQ(record.sigmaMax, 4.0f);
    EXPECT_EQ(record.sigmaRatio, glm::vec3(0.25f, 1.0f, 0.5f));
    EXPECT_EQ(record.albedo, glm::vec3(0.25f, 0.5f, 1.0f));
    EXPECT_EQ(record.flags, shared::kMediumHomogeneous);
    EXPECT_TRUE(compiled.density.empty());
    EXPECT_TRUE(compiled.effects.has(Effect::hasChromaticExtinction));
}

TEST(CompiledMedia, GridCoordinatesAreVoxels) {
    MediumDescription cloud = gridMedium("m", counting({4, 8, 16}));
    cloud.density->toWorld = translation({1, 2, 3}) * scaling({2, 2, 2});
    const shared::Medium record = compileScene(sceneWith({cloud})).constants.media[0];
    // World (1, 2, 3) is scene (1, 2, 13). All numbers are dyadic: exact.
    EXPECT_EQ(record.gridFromWorld * glm::vec4(1, 2, 13, 1), glm::vec3(0, 0, 0));
    EXPECT_EQ(record.gridFromWorld * glm::vec4(3, 4, 15, 1), glm::vec3(4, 8, 16));
    EXPECT_EQ(record.resolution, glm::uvec3(4, 8, 16));
    const unsigned cell = shared::kVoxelsPerCell << record.cellLevel;
    EXPECT_EQ(record.cells, (record.resolution + cell - 1u) / cell);
}

TEST(CompiledMedia, StoresGridsOneAfterTheOther) {
    const DensityGrid a = counting({5, 3, 2}), b = counting({9, 9, 9});
    const CompiledScene compiled = compileScene(sceneWith({gridMedium("a", a), medium("fog"), gridMedium("b", b)}));
    const shared::Medium* media = compiled.constants.media;
    ASSERT_EQ(compiled.constants.mediumCount, 3u);
    ASSERT_EQ(compiled.density.size(), 30u + 729);
    EXPECT_EQ(media[0].voxelOffset, 0u);
    EXPECT_EQ(media[2].voxelOffset, 30u);
    EXPECT_EQ(media[2].cellOffset, 1u);
    EXPECT_EQ(compiled.majorants.size(), 1u + media[2].cells.x * media[2].cells.y * media[2].cells.z);
    EXPECT_EQ(compiled.density[30 + (8 * 9 + 7) * 9 + 6], b.at({6, 7, 8}));
    EXPECT_TRUE(compiled.effects.has(Effect::hasManyMedia));
}

TEST(CompiledMedia, AConstantGridStaysAGrid) {
    const DensityGrid grid = DensityGrid::fromDense({2, 2, 2}, std::vector<float>(8, 0.5f));
    const CompiledScene compiled = compileScene(sceneWith({gridMedium("m", grid)}));
    EXPECT_EQ(compiled.constants.media[0].flags, 0u);
    EXPECT_TRUE(compiled.effects.has(Effect::hasHeterogeneousMedia));
    EXPECT_FALSE(compiled.effects.has(Effect::hasHomogeneousMedia));
}

TEST(CompiledMedia, EmptyGridsAreDroppedWithANote) {
    const CompiledScene compiled = compileScene(sceneWith({gridMedium("m", DensityGrid({4, 4, 4}))}));
    EXPECT_EQ(compiled.constants.mediumCount, 0u);
    EXPECT_TRUE(compiled.shapes.empty());
    EXPECT_TRUE(contains(compiled.notes.at(0), "medium \"m\" was dropped: its density grid is zero"));
}

TEST(CompiledMedia, PhaseFunctionsAreReducedAndLimited) {
    const auto phaseOf = [](double g) {
        MediumDescription result = medium("m");
        result.phase.type = PhaseDescription::Type::HenyeyGreenstein;
        result.phase.g = g;
        return compileScene(sceneWith({result}));
    };
    EXPECT_EQ(phaseOf(0.0).constants.media[0].phase, shared::kPhaseIsotropic);
    EXPECT_FALSE(phaseOf(0.0).effects.has(Effect::hasHenyeyGreenstein));
    EXPECT_EQ(phaseOf(0.8).constants.media[0].g, 0.8f);
    EXPECT_TRUE(phaseOf(0.8).notes.empty());
    const CompiledScene backward = phaseOf(-1.0 + 1e-9);
    EXPECT_EQ(backward.constants.media[0].g, -(1.0f - 0x1p-20f));
    EXPECT_EQ(backward.notes.size(), 1u);
}

TEST(CompiledMedia, AlbedoGridsAreStoredOrFolded) {
    MediumDescription cloud = medium("m");
    cloud.albedoGrid = GridPlacement{};
    Volume& volume = cloud.albedoGrid->volume;
    volume.channels = 3;
    volume.color.resolution = {2, 1, 1};
    volume.color.values = {0.1f, 0.2f, 0.3f, 0.1f, 0.2f, 0.3f};
    const CompiledScene folded = compileScene(sceneWith({cloud}));
    EXPECT_EQ(folded.constants.media[0].albedo, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_TRUE(folded.albedoVoxels.empty());

    volume.color.values[5] = 0.4f;
    const CompiledScene stored = compileScene(sceneWith({cloud}));
    EXPECT_TRUE(stored.constants.media[0].flags & shared::kMediumAlbedoGrid);
    ASSERT_EQ(stored.albedoVoxels.size(), 2u);
    EXPECT_EQ(stored.albedoVoxels[1], glm::vec4(0.1f, 0.2f, 0.4f, 0.0f));
    EXPECT_TRUE(stored.effects.has(Effect::hasAlbedoGrids));

    volume.color.values[5] = 1.5f;
    EXPECT_TRUE(contains(inputErrorOf(sceneWith({cloud})), "albedo must be in [0, 1]"));
}

TEST(DensityStorage, SparseLargeGridsMakeAllGridsBricked) {
    DensityGrid large({512, 256, 256});  // 128 MiB dense
    large.set({100, 7, 9}, 0.5f);
    large.set({511, 255, 255}, 0.25f);
    const DensityGrid small = counting({9, 2, 2});
    const CompiledScene compiled = compileScene(sceneWith({gridMedium("small", small), gridMedium("large", large)}));
    EXPECT_TRUE(compiled.effects.has(Effect::hasBrickedDensity));
    EXPECT_EQ(compiled.density.size(), 4u * 512) << "two bricks of each";
    for (int m = 0; m < 2; ++m) {
        const DensityGrid& grid = m == 0 ? small : large;
        const shared::Medium& record = compiled.constants.media[m];
        EXPECT_TRUE(record.flags & shared::kMediumBricked);
        const glm::uvec3 counts = grid.brickCounts();
        for (const glm::uvec3 voxel :
             {glm::uvec3(8, 1, 1), glm::uvec3(100, 7, 9), glm::uvec3(511, 255, 255), glm::uvec3(0)}) {
            if (glm::any(glm::greaterThanEqual(voxel, grid.resolution()))) continue;
            const glm::uvec3 b = voxel / 8u, v = voxel % 8u;
            const std::uint32_t first =
                compiled.brickTable[record.voxelOffset + (b.z * counts.y + b.y) * counts.x + b.x];
            const float value =
                first == shared::kEmptyBrick ? 0.0f : compiled.density[first + (v.z * 8 + v.y) * 8 + v.x];
            EXPECT_EQ(value, grid.at(voxel));
        }
    }
}

TEST(DensityStorage, DenselyFilledOrSmallGridsStayDense) {
    const DensityGrid small({64, 64, 64});
    DensityGrid full({512, 256, 256});
    for (std::size_t i = 0; i < full.brickTable().size(); ++i)
        if (i % 3 != 2) full.set(full.brickAt(i) * 8u, 1.0f);  // two bricks of three
    const DensityGrid* grids[] = {&small, &full};
    const DensityPlan plan = planDensityStorage(grids);
    EXPECT_FALSE(plan.bricked);
    EXPECT_EQ(plan.voxels, 64u * 64 * 64 + 512u * 256 * 256);
    // 2^27 voxels fit, one more makes bricks of all.
    const DensityGrid eighth({256, 256, 256});
    std::vector<const DensityGrid*> many(8, &eighth);
    EXPECT_FALSE(planDensityStorage(many).bricked);
    const DensityGrid one({1, 1, 1});
    many.push_back(&one);
    EXPECT_TRUE(planDensityStorage(many).bricked);
}

TEST(CompiledMedia, LimitsAreStated) {
    std::vector<MediumDescription> many(shared::kMaxMedia + 1, medium("m"));
    EXPECT_TRUE(contains(inputErrorOf(sceneWith(many)), "at most 16 media; got 17"));
}

TEST(CompiledMedia, GridsBeyondTheLimitsAreBlamedWhereTheyAreRead) {
    MediumDescription small = gridMedium("small", counting({2, 2, 2})),
                      large = gridMedium("large", counting({8, 8, 8}));
    small.density->where = {"scene.xml", 3, 1};
    large.density->where = {"scene.xml", 9, 5};
    CompileOptions options;
    options.memoryLimitBytes = 1000;
    const std::string error = inputErrorOf(sceneWith({small, large}), options);
    EXPECT_EQ(error.rfind("scene.xml:9:5: medium \"large\": density of 8 x 8 x 8 voxels", 0), 0u) << error;
    EXPECT_TRUE(contains(error, "need 2088 bytes of memory; allowed are 1000")) << error;  // 520 voxels and 2 majorants
    EXPECT_TRUE(contains(error, "half as many voxels along each axis"));
    // A slice of voxels more than a texel buffer holds; as bricks of zeros it takes 1 MiB here.
    MediumDescription cloud = medium("m");
    cloud.albedoGrid = GridPlacement{};
    cloud.albedoGrid->where = {"scene.xml", 4, 2};
    cloud.albedoGrid->volume.density = DensityGrid({513, 512, 512});
    const std::string beyond = inputErrorOf(sceneWith({cloud}));
    EXPECT_EQ(beyond.rfind("scene.xml:4:2: ", 0), 0u) << beyond;
    EXPECT_TRUE(contains(beyond, "need 134479872 voxels of albedo; allowed are 134217728")) << beyond;
}

TEST(CompiledMedia, PositionsCoarserThanTheMeanFreePathAreNoted) {
    // The camera is 10 away: the cube's far face has coordinate 11, where neighbours may be 11 * 2^-23 apart.
    const double spacing = 11 * 0x1p-23;
    const auto notesOf = [](double sigma, double density, double z = 0) {
        MediumDescription fog = gridMedium("fog", DensityGrid::fromDense({1, 1, 1}, std::vector{float(density)}));
        fog.sigmaT = glm::dvec3(sigma);
        SceneDescription description = sceneWith({fog});
        description.shapes[0].toWorld = translation({0, 0, z}) * scaling({1, 1, 1});
        return compileScene(description).notes;
    };
    EXPECT_TRUE(notesOf(0.99 / (8 * spacing), 1).empty());
    EXPECT_TRUE(notesOf(1.98 / (8 * spacing), 0.5).empty()) << "the density counts";
    const std::vector<std::string> notes = notesOf(1.01 / (8 * spacing), 1);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_TRUE(contains(notes[0], "medium \"fog\" in cube \"box\": its mean free path, 1.04e-05")) << notes[0];
    EXPECT_FALSE(notesOf(0.99 / (8 * spacing), 1, 1).empty()) << "so does the distance";
    EXPECT_TRUE(notesOf(1.01 / (8 * spacing), 1, -1).empty());
}

TEST(CompiledMedia, SingularPlacementsAndOverflowAreRefused) {
    MediumDescription flat = gridMedium("m", counting({2, 2, 2}));
    flat.density->toWorld = scaling({1, 1, 0});
    EXPECT_TRUE(contains(inputErrorOf(sceneWith({flat})), "invertible"));
    MediumDescription bright = gridMedium("m", DensityGrid::fromDense({1, 1, 1}, std::vector<float>{1e20f}));
    bright.sigmaT = glm::dvec3(1e20);
    EXPECT_TRUE(contains(inputErrorOf(sceneWith({bright})), "single precision"));
}

MediumDescription colorMedium(glm::uvec3 resolution, const std::vector<float>& values) {
    MediumDescription medium = gridMedium("m", DensityGrid());
    medium.density->volume.channels = 3;
    medium.density->volume.color = {resolution, values};
    return medium;
}

TEST(CompiledMedia, EqualChannelsFoldToGrey) {
    const CompiledScene grey = compileScene(sceneWith({colorMedium({2, 1, 1}, {3, 3, 3, 5, 5, 5})}));
    EXPECT_EQ(grey.density, (std::vector<float>{3, 5}));
    EXPECT_FALSE(grey.effects.has(Effect::hasColorDensity) || grey.effects.has(Effect::hasChromaticExtinction));
    const std::vector<float> values{3, 3, 3, 5, 5, 4};
    const CompiledScene coloured = compileScene(sceneWith({colorMedium({2, 1, 1}, values)}));
    EXPECT_EQ(coloured.density, values);
    EXPECT_TRUE(coloured.effects.has(Effect::hasColorDensity) && coloured.effects.has(Effect::hasChromaticExtinction));
    EXPECT_EQ(coloured.constants.media[0].resolution, glm::uvec3(2, 1, 1));
    const CompiledScene empty = compileScene(sceneWith({colorMedium({2, 1, 1}, {0, 0, 0, 0, 0, 0})}));
    EXPECT_EQ(empty.constants.mediumCount, 0u);
}

// Every voxel that the interpolant reads in a cell, one beyond its faces included, in every channel, lies below its
// bound.
TEST(CompiledMedia, MajorantsBoundEveryChannelHalosIncluded) {
    const glm::ivec3 n(19, 10, 9);
    std::vector<float> values;
    for (int i = 0; i < 3 * n.x * n.y * n.z; ++i) values.push_back(float(i * 7919 % 1009) * (i % 3 == 1 ? 4.0f : 0.1f));
    const CompiledScene scene = compileScene(sceneWith({colorMedium(n, values)}));
    const glm::ivec3 cells(scene.constants.media[0].cells);
    ASSERT_EQ(cells, glm::ivec3(3, 2, 2));
    for (int cell = 0; cell < cells.x * cells.y * cells.z; ++cell) {
        const glm::ivec3 at(cell % cells.x, cell / cells.x % cells.y, cell / cells.x / cells.y);
        float largest = 0;
        for (int z = 8 * at.z - 1; z <= 8 * at.z + 8; ++z)
            for (int y = 8 * at.y - 1; y <= 8 * at.y + 8; ++y)
                for (int x = 8 * at.x - 1; x <= 8 * at.x + 8; ++x) {
                    const glm::ivec3 v = glm::clamp(glm::ivec3(x, y, z), glm::ivec3(0), n - 1);
                    for (int c = 0; c < 3; ++c)
                        largest = std::max(largest, values[3 * ((v.z * n.y + v.y) * n.x + v.x) + c]);
                }
        EXPECT_GT(scene.majorants.at(cell), largest) << "rounded up";
        EXPECT_LT(scene.majorants.at(cell), largest * 1.00001f) << "and tight";
    }
}

}  // namespace
}  // namespace parhelion
