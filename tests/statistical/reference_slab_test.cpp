#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "reference/reference_renderer.h"
#include "support/hand_scene.h"
#include "support/shared_data.h"
#include "support/slab.h"

// Exact slabs in scenes put together by hand, in float and in double; as scene files, on both back ends: slabs_test.
namespace parhelion {
namespace {

using test::HandScene;
using test::PixelEstimate;
using test::SlabRow;
using test::SlabScores;

/// Radiance of the slab seen from above at cosine mu under a uniform unit sky from above or from below. By
/// reciprocity it is the slab's albedo, or its transmittance, for light incident at mu.
PixelEstimate seeSlab(const SlabRow& slab, double mu, bool litFromAbove, bool inDouble, std::uint64_t samples,
                      float extinction = 1) {
    HandScene scene;
    scene.lookAlong({float(std::sqrt(1 - mu * mu)), 0, float(-mu)});
    const std::uint32_t black = scene.addDiffuse(glm::vec3(0), shared::kShapeTwoSided);
    const std::uint32_t fog =
        scene.addNull(scene.addHomogeneous(extinction, glm::vec3(float(slab.albedo)), float(slab.g)));
    // 2000 mean free paths wide: what leaves at the sides is below 1e-3 of a mean free path / 1000.
    const float bottom = -1 - float(slab.tau), screen = litFromAbove ? bottom - 1 : 1;
    scene.addQuad({-1e6f, -1e6f, screen}, {2e6f, 0, 0}, {0, 2e6f, 0}, black);
    scene.addBox({-1000, -1000, bottom}, {1000, 1000, -1}, fog);
    scene.setEnvironment(glm::vec3(1));
    return test::renderPixel(scene.scene, samples, inDouble);
}

// Wrong albedo or g (+ 0.01), a lost boundary or a repeated random number all show here. What is reflected and what is
// let through are judged apart: where nothing is absorbed they sum to 1, and their errors would cancel.
TEST(ReferenceSlab, MatchesAddingDoubling) {
    const auto table = test::sharedFile("references/slabs.csv");
    if (table.empty()) GTEST_SKIP() << "../shared/references/slabs.csv is missing";
    const std::vector<SlabRow> rows = test::readSlabRows(table);
    SlabScores reflected(2 * rows.size()), transmitted(2 * rows.size());
    int compared = 0;
    for (const SlabRow& row : rows) {
        if (row.weight != 1 || row.tau > 5) continue;
        const bool inDouble = ++compared % 2 == 0;
        for (const bool litFromAbove : {true, false})
            for (const double mu : {1.0, 0.5})
                (litFromAbove ? reflected : transmitted)
                    .add(seeSlab(row, mu, litFromAbove, inDouble, 60'000), row.exact(mu, litFromAbove),
                         fmt::format("{} {} at mu {}", row.name(), litFromAbove ? "R" : "T", mu));
    }
    EXPECT_GE(compared, 20);
    // A path ends outside or inside: the variance of p is at most p (1 - p), which gives 0.66 % and 0.15 %.
    reflected.expectNoCommonBias(0.0067, "reflected");
    transmitted.expectNoCommonBias(0.0015, "transmitted");
}

// Simulated apart from the renderer, 2 % less extinction takes 0.49 % from what this slab reflects, and adds 1.75 % to
// what it lets through; one sample's variation is 0.68 and 1.5.
TEST(ReferenceSlab, ExtinctionOffByTwoPercentShows) {
    const SlabRow row{.tau = 4, .albedo = 0.99, .g = 0, .reflected1 = 0.645047, .transmitted1 = 0.275480};
    for (const bool litFromAbove : {true, false}) {
        const std::uint64_t samples = litFromAbove ? 1'100'000 : 500'000;
        SlabScores right(1), wrong(1);
        right.collect(seeSlab(row, 1, litFromAbove, false, samples), row.exact(1, litFromAbove));
        wrong.collect(seeSlab(row, 1, litFromAbove, false, samples, 0.98f), row.exact(1, litFromAbove));
        EXPECT_FALSE(right.haveCommonBias()) << litFromAbove;
        EXPECT_TRUE(wrong.haveCommonBias()) << litFromAbove;
    }
}

TEST(ReferenceSlab, MatchesPublishedValues) {
    // Chandrasekhar's and van de Hulst's numbers, as recomputed by adding-doubling to 6 decimals.
    SlabScores scores(6);
    const auto reflects = [&](const SlabRow& slab, bool inDouble, std::uint64_t samples, const char* what) {
        scores.add(seeSlab(slab, 1, true, inDouble, samples), slab.reflected1, what);
    };
    reflects({.tau = 1, .albedo = 1, .g = 0, .reflected1 = 0.341329}, true, 100'000, "tau 1");
    reflects({.tau = 4, .albedo = 0.99, .g = 0, .reflected1 = 0.645047}, true, 50'000, "tau 4");
    reflects({.tau = 2, .albedo = 0.9, .g = 0.75, .reflected1 = 0.0973946}, false, 200'000, "van de Hulst R");
    reflects({.tau = 2, .albedo = 0.9, .g = -0.5, .reflected1 = 0.462772}, false, 100'000, "backward R");
    reflects({.tau = 64, .albedo = 0.9, .g = 0, .reflected1 = 0.414947}, false, 100'000, "half-space");
    scores.expectNoCommonBias(0.015, "published R");
    const SlabRow hulst{.tau = 2, .albedo = 0.9, .g = 0.75};
    scores.add(seeSlab(hulst, 1, false, false, 100'000), 0.6609577, "van de Hulst T");
}

TEST(ReferenceSlab, OpticalDepthIsIndependentOfScale) {  // H29, H85
    // A slab of the same optical thickness, 2^20 times as small or large: the same paths to the bit.
    const auto film = [](float scale) {
        HandScene scene;
        scene.lookAlong({0.6f, 0, -0.8f});
        const std::uint32_t fog = scene.addNull(scene.addHomogeneous(1 / scale, glm::vec3(0.9f), 0.6f));
        scene.addBox(scale * glm::vec3(-100, -100, -5), scale * glm::vec3(100, 100, -1), fog);
        scene.setEnvironment(glm::vec3(1));
        RenderSettings settings;
        settings.sampleCount = 1000;
        return reference::render<float>(scene.scene, settings).pixels.at(0).sumHigh.x;
    };
    EXPECT_EQ(film(0x1p-20f), film(1));
    EXPECT_EQ(film(0x1p20f), film(1));
}

}  // namespace
}  // namespace parhelion
