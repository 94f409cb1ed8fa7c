#include "reference/reference_renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "reference/integrator/film.h"
#include "support/hand_scene.h"

namespace parhelion::reference {
namespace {

using test::HandScene;

/// A bit of everything: a floor, a light, a mesh, a homogeneous ball and a lumpy box of grid density.
HandScene everything() {
    HandScene scene;
    scene.lookAt({0.1f, 0.2f, -1}, {12, 8});
    const std::uint32_t wall = scene.addDiffuse({0.7f, 0.6f, 0.5f}), lamp = scene.addDiffuse(glm::vec3(0));
    const std::uint32_t ball = scene.addNull(scene.addHomogeneous(2, {0.9f, 0.8f, 0.7f}, 0.6f));
    std::vector<float> voxels(16 * 16 * 16);
    for (std::size_t i = 0; i < voxels.size(); ++i) voxels[i] = float(i * 2654435761u % 1000u) / 1000;
    const glm::vec3 low{-2, -2, -5}, high{1, 0, -3};
    const std::uint32_t lumps = scene.addNull(scene.addGrid(5, glm::vec3(0.95f), {16, 16, 16}, voxels, low, high));
    scene.addQuad({-5, -5, -6}, {10, 0, 0}, {0, 10, 0}, wall);
    scene.addAreaLight(shared::kLightQuad, scene.addQuad({-1, 2, -5}, {2, 0, 0}, {0, 0, 2}, lamp), lamp, glm::vec3(9));
    scene.addSphere({1.5f, 1, -4}, 0.9f, ball);
    scene.addBox(low, high, lumps);
    std::vector<glm::vec3> mesh = test::icosphere(1);
    for (glm::vec3& p : mesh) p = p * 0.5f + glm::vec3(-1, 1.2f, -4);
    scene.addTriangles(mesh, scene.addDiffuse(glm::vec3(0.8f)));
    scene.setEnvironment({0.2f, 0.3f, 0.4f});
    scene.scene.constants.rouletteDepth = 4;
    return scene;
}

RenderSettings samples(std::uint64_t count, std::uint64_t first = 0) {
    RenderSettings settings;
    settings.sampleCount = count;
    settings.firstSample = first;
    return settings;
}

bool areEqual(const Film& a, const Film& b) {
    return a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(a.pixels[0])) == 0;
}

TEST(ReferenceRenderer, IsDeterministic) {
    const HandScene scene = everything();
    EXPECT_TRUE(areEqual(render<float>(scene.scene, samples(20)), render<float>(scene.scene, samples(20))));
}

TEST(ReferenceRenderer, TwoWindowsOfSamplesAreOneRun) {  // H82
    const HandScene scene = everything();
    const Film whole = render<float>(scene.scene, samples(21));
    const Film first = render<float>(scene.scene, samples(13)), second = render<float>(scene.scene, samples(8, 13));
    for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
        const double parts = test::estimate(first.pixels[i], 1).mean + test::estimate(second.pixels[i], 1).mean;
        // Compensated sums of 21 values hold them to about a rounding of the float they end in.
        EXPECT_NEAR(test::estimate(whole.pixels[i], 1).mean, parts, 1e-6 * (1 + parts));
    }
}

TEST(ReferenceRenderer, SampleIndicesBeyond32BitsAreTheirOwn) {  // H76
    const HandScene scene = everything();
    EXPECT_FALSE(areEqual(render<float>(scene.scene, samples(4)), render<float>(scene.scene, samples(4, 1ull << 32))));
}

TEST(ReferenceRenderer, CropsAreCutOutOfTheWholeFilm) {
    HandScene scene = everything();
    const Film whole = render<float>(scene.scene, samples(6));
    scene.scene.cropOffset = {3, 2};
    scene.scene.cropSize = {5, 4};
    const Film crop = render<float>(scene.scene, samples(6));
    ASSERT_EQ(crop.pixels.size(), 20u);
    for (unsigned y = 0; y < 4; ++y)
        for (unsigned x = 0; x < 5; ++x) {
            EXPECT_EQ(crop.pixels[y * 5 + x].sumHigh, whole.pixels[(y + 2) * 12 + x + 3].sumHigh);
            EXPECT_EQ(crop.features[y * 5 + x].normal, whole.features[(y + 2) * 12 + x + 3].normal);
        }
}

TEST(ReferenceRenderer, StopsBetweenPassesAndSaysHowFarItCame) {
    const HandScene scene = everything();
    std::atomic<bool> stop = false;
    std::uint64_t reported = 0;
    const Film film = render<float>(scene.scene, samples(1000000), &stop, [&](std::uint64_t done) {
        reported = done;
        if (done >= 3) stop = true;
    });
    EXPECT_EQ(film.samples, reported);
    EXPECT_EQ(film.counters[shared::kCounterPathsFinished], reported * film.pixels.size());
    EXPECT_LT(reported, 1000u);
    EXPECT_TRUE(areEqual(film, render<float>(scene.scene, samples(reported))));
}

TEST(ReferenceRenderer, TracedSamplesAddUpToTheFilm) {
    const HandScene scene = everything();
    const RenderSettings settings = samples(5);
    const Film film = render<float>(scene.scene, settings);
    Counters counters{};
    for (unsigned y = 0; y < 8; ++y)
        for (unsigned x = 0; x < 12; ++x) {
            shared::FilmPixel pixel{};
            for (std::uint64_t s = 0; s < 5; ++s) {
                PathTrace trace;
                const glm::vec3 radiance = tracePath<float>(scene.scene, settings, {x, y}, s);
                EXPECT_EQ(tracePath<float>(scene.scene, settings, {x, y}, s, &trace), radiance);
                accumulate(pixel, radiance, s == 0, counters);
            }
            EXPECT_EQ(pixel.sumHigh, film.pixels[y * 12 + x].sumHigh);
        }
}

TEST(ReferenceRenderer, FloatAndDoubleTakeTheSamePathsUnlessADecisionIsClose) {
    const HandScene scene = everything();
    int diverged = 0;
    double predicted = 0;
    for (std::uint64_t s = 0; s < 20000; ++s) {
        PathTrace inFloat, inDouble;
        const glm::uvec2 pixel{s % 12, s / 12 % 8};
        const glm::dvec3 a = tracePath<float>(scene.scene, samples(1), pixel, s, &inFloat);
        const glm::dvec3 b = tracePath<double>(scene.scene, samples(1), pixel, s, &inDouble);
        if (inFloat.hash != inDouble.hash) {
            ++diverged;
            continue;
        }
        // A weight that roulette has set to its threshold may be a rounding below it afterwards: one decision more.
        const bool areAlike = inFloat.decisions.size() == inDouble.decisions.size();
        for (std::size_t i = 0; areAlike && i < inFloat.decisions.size(); ++i)
            predicted += std::abs(inFloat.decisions[i].probability - inDouble.decisions[i].probability);
        // Some 100 operations of 2^-24 each; a grazing cosine or a near light costs a digit more.
        EXPECT_LE(glm::length(a - b), 1e-4 * (glm::length(b) + 1e-3)) << s;
    }
    // Besides these, a position off by 1e-6 of a voxel takes another corner with that probability: some 10 lookups a
    // path on 3 axes give 0.6 of 20000 paths. More than 8 have a probability of 1e-7.
    EXPECT_LE(diverged, 8) << "predicted by decisions alone: " << predicted;
}

TEST(ReferenceRenderer, NonFiniteAndNegativeSamplesAreCounted) {  // H78
    shared::FilmPixel pixel{};
    Counters counters{};
    accumulate(pixel, glm::vec3(1, std::numeric_limits<float>::quiet_NaN(), 1), true, counters);
    accumulate(pixel, glm::vec3(1, 2, std::numeric_limits<float>::infinity()), false, counters);
    accumulate(pixel, glm::vec3(1, -2, 3), false, counters);
    EXPECT_EQ(counters[shared::kCounterNonFinite], 2u);
    EXPECT_EQ(counters[shared::kCounterNegative], 1u);
    EXPECT_EQ(pixel.sumHigh, glm::vec3(1, -2, 3));
}

TEST(ReferenceRenderer, MillionsOfEqualSamplesKeepTheirSum) {  // H77: naive float sums are off by 1 %
    shared::FilmPixel inFloat{}, inDouble{};
    Counters counters{};
    for (int i = 0; i < 1000000; ++i) {
        accumulate(inFloat, glm::vec3(0.1f), i == 0, counters);
        accumulate(inDouble, glm::dvec3(0.1f), i == 0, counters);
    }
    const double exact = 1e6 * double(0.1f);
    EXPECT_NEAR(test::estimate(inFloat, 1).mean / exact, 1, 1e-7);
    EXPECT_NEAR(test::estimate(inDouble, 1).mean / exact, 1, 1e-9);
    EXPECT_NEAR(inFloat.squareHigh.x / (exact * double(0.1f)), 1, 1e-6);
}

TEST(ReferenceRenderer, FeaturesShowTheFirstOpaqueSurfaceThroughMedia) {
    HandScene scene;
    scene.lookAlong({0, 0, -1});
    const std::uint32_t fog = scene.addNull(scene.addHomogeneous(50, glm::vec3(0.5f)));
    scene.addQuad({-1, -1, -6}, {2, 0, 0}, {0, 2, 0}, scene.addDiffuse({0.1f, 0.2f, 0.3f}));
    scene.addBox({-1, -1, -4}, {1, 1, -2}, fog);
    const Film film = render<float>(scene.scene, samples(1));
    const shared::FeaturePixel& sums = film.features.at(0);
    const auto count = float(film.featureSamples);
    EXPECT_EQ(count, 16.0f);
    EXPECT_EQ(sums.hits, count);
    EXPECT_FLOAT_EQ(sums.depth, 6 * count);
    EXPECT_FLOAT_EQ(sums.albedo.z, 0.3f * count);
    EXPECT_EQ(sums.normal, glm::vec3(0, 0, count));
}

TEST(ReferenceRenderer, FilterTablesMoveFilmPositions) {
    // An environment seen through a slit: with the box filter a pixel away sees nothing, with a wide one it does.
    HandScene scene;
    scene.lookAt({0, 0, -1}, {4, 4});
    scene.addQuad({-2, -2, -1}, {2, 0, 0}, {0, 4, 0}, scene.addDiffuse(glm::vec3(0), shared::kShapeTwoSided));
    scene.setEnvironment(glm::vec3(1));
    const auto lit = [&] {
        int pixels = 0;
        for (const shared::FilmPixel& pixel : render<double>(scene.scene, samples(200)).pixels)
            pixels += pixel.sumHigh.x > 0;
        return pixels;
    };
    EXPECT_EQ(lit(), 8);
    for (int i = 0; i <= 256; ++i) scene.scene.filterTable.push_back(float(i - 128) / 64);  // box of radius 2
    shared::Camera& camera = scene.scene.constants.camera;
    camera.hasFilter = 1;
    camera.filmUpper = {4, 4};
    EXPECT_EQ(lit(), 16);
}

}  // namespace
}  // namespace parhelion::reference
