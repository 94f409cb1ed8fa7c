#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "reference/geometry/intersection.h"
#include "reference/reference_renderer.h"
#include "support/tracked_medium.h"

// Media so thin that hardly anything collides, and rays without an end.
namespace parhelion {
namespace {

using test::HandScene;
using test::TrackedMedium;
using test::Tracker;

constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// Share of the 2^48 random numbers whose flight ends before optical depth `tau`, exactly: flights grow with them.
template <typename Exponential>
double collidingShare(double tau, const Exponential& exponential) {
    std::uint64_t low = 0, high = std::uint64_t(1) << 48;
    while (low < high) {
        const std::uint64_t middle = (low + high) / 2;
        if (double(exponential(middle)) < tau)
            low = middle + 1;
        else
            high = middle;
    }
    return std::ldexp(double(low), -48);
}

// H13: 1 - exp(-tau) to a relative 1e-6, where floats next to 1 are 6e-8 apart.
TEST(ThinMedia, CollideWithTheirProbability) {
    const auto ours = [](std::uint64_t n) {
        return reference::exponential<float>(std::uint32_t(n >> 24) << 8, std::uint32_t(n & 0xffffff));
    };
    const auto naive = [](std::uint64_t n) { return -std::log(1 - float(n >> 24) * 0x1p-24f); };
    for (const double tau : {1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 9e-4}) {
        const double exact = -std::expm1(-tau);
        // 2^-48 / 1e-8 = 3.6e-7 is one number; rounding of the complement and of log1p is 2 * 2^-24.
        EXPECT_NEAR(collidingShare(tau, ours) / exact, 1, 1e-6) << tau;
        if (tau <= 1e-5) {
            EXPECT_GT(std::abs(collidingShare(tau, naive) / exact - 1), 1e-4) << "24 bits and a plain logarithm";
            EXPECT_GT(std::abs(double(1 - std::exp(-float(tau))) / exact - 1), 1e-4) << "1 - exp(-tau)";
        }
    }
}

// The tracking itself, with the residual just on either side: it collides at residual / sigma, not at a rounded 0 or 1.
TEST(ThinMedia, CollideWhereTheirOpticalDepthIs) {
    const float sigma = 1e-8f;
    const TrackedMedium medium = TrackedMedium::homogeneous(sigma, 1);
    const reference::SceneView<float> view(medium.scene.scene);
    const Quality quality;
    reference::Counters counters{};
    reference::NoTrace trace;
    const reference::PathContext<float, reference::NoTrace> path{view, quality,  reference::streamOf(0, 0, 0, 0),
                                                                 0,    counters, trace};
    const auto fly = [&](float depth) {
        reference::Residual<float> residual{depth};
        reference::Throughput<float> throughput;
        return trackFlight(path, view.media[0], medium.ray, 1.0f, 0, residual, throughput);
    };
    for (const float t : {0.001f, 0.25f, 0.999f}) {
        const auto found = fly(t * sigma);
        ASSERT_TRUE(found) << t;
        EXPECT_NEAR(*found / t, 1, 1e-6);
    }
    EXPECT_FALSE(fly(1.000001f * sigma));
}

/// A grid with an empty half, crossed by a ray that has an end, or none.
TrackedMedium halfEmpty(float tEnd) {
    std::vector<float> voxels(32 * 4 * 4);
    for (std::size_t i = 0; i < voxels.size(); ++i) voxels[i] = i % 32 < 16 ? 0.0f : 0.5f + float(i % 7) / 16;
    TrackedMedium medium = TrackedMedium::grid(3, {32, 4, 4}, voxels, {8, 1, 1}, {-1, 0.5f, 0.5f}, {9, 0.4f, 0.6f});
    medium.tEnd = tEnd;
    return medium;
}

// H54: the segment is cut to the grid before anything is multiplied by its length.
TEST(EndlessRays, SeeAGridAsRaysWithAnEndDo) {
    const TrackedMedium finite = halfEmpty(20), endless = halfEmpty(kInfinite);
    for (const bool isGrey : {true, false}) {
        Tracker a(finite), b(endless);
        for (Tracker* tracker : {&a, &b}) {
            if (isGrey) continue;
            tracker->medium().sigmaRatio = {0, 0.5f, 1};  // nothing times infinity in the first channel
            tracker->medium().grey = false;
        }
        for (std::uint32_t i = 0; i < 20'000; ++i) {
            ASSERT_EQ(a.fly(i), b.fly(i)) << i;
            ASSERT_EQ(a.transmit(i, 0.5f), b.transmit(i, 0.5f)) << i;
        }
        EXPECT_EQ(a.counters(), b.counters()) << "nor does it take more steps";
    }
    // What the naive step to the ray's end meets: in an empty cell, and where the ray ends.
    EXPECT_TRUE(std::isnan(3 * 0.0f * (kInfinite - 1.0f)));
    EXPECT_FALSE(std::isfinite(endless.ray.origin.x + kInfinite * endless.ray.direction.x));
    EXPECT_TRUE(std::isnan(kInfinite - kInfinite));
}

/// Something of every kind, under lights whose shadow rays have no end.
HandScene everything() {
    HandScene scene;
    scene.lookAt({0, 0, -1}, {8, 8});
    const std::uint32_t grey = scene.addDiffuse(glm::vec3(0.5f), shared::kShapeTwoSided);
    scene.addQuad({-3, -1, -6}, {6, 0, 0}, {0, 0, 5}, grey);
    scene.addSphere({1, 0, -4}, 0.5f, grey);
    scene.addSphere({-1, 0, -4}, 0.7f, scene.addNull(scene.addHomogeneous(2, glm::vec3(0.9f), 0, {0, 0.5f, 1})));
    const std::vector<float> voxels{0, 0, 1, 1, 0, 0.5f, 0, 0.25f};
    scene.addBox({-2, 1, -5}, {2, 2, -3},
                 scene.addNull(scene.addGrid(4, glm::vec3(0.9f), {2, 2, 2}, voxels, {-2, 1, -5}, {2, 2, -3})));
    std::vector<glm::vec3> mesh = test::icosphere(1);
    for (glm::vec3& vertex : mesh) vertex = 0.4f * vertex + glm::vec3(0, 0.2f, -3.5f);
    scene.addTriangles(mesh, grey);
    shared::Light sun{};
    sun.type = shared::kLightDirectional;
    sun.emission = {3, 2, 1};
    sun.vector = glm::normalize(glm::vec3(0.2f, -1, -0.1f));
    scene.addLight(sun);
    scene.setEnvironment({0.2f, 0.4f, 0.8f});
    return scene;
}

TEST(EndlessRays, MeetWhatRaysWithAFarEndMeet) {
    const HandScene scene = everything();
    const reference::SceneView<float> view(scene.scene);
    int found = 0;
    for (int i = 0; i < 4096; ++i) {
        reference::Ray<float> ray;
        ray.origin = glm::vec3(0);
        ray.direction = glm::normalize(glm::vec3(float(i % 64) / 32 - 1, float(i / 64) / 32 - 1, -1));
        ray.tMax = kInfinite;
        const reference::Hit<float> endless = closestHit(view, ray);
        ray.tMax = 1e30f;
        const reference::Hit<float> finite = closestHit(view, ray);
        ASSERT_EQ(endless.primitive, finite.primitive);
        ASSERT_EQ(endless.found() ? endless.t : 0, finite.found() ? finite.t : 0);
        found += endless.found();
    }
    EXPECT_GT(found, 1000);
    RenderSettings settings;
    settings.sampleCount = 256;
    settings.featureSamples = 0;
    const Film film = reference::render<float>(scene.scene, settings);
    EXPECT_EQ(film.counters[shared::kCounterNonFinite], 0u);
    EXPECT_EQ(film.counters[shared::kCounterNegative], 0u);
    for (const shared::FilmPixel& pixel : film.pixels)
        ASSERT_TRUE(std::isfinite(pixel.sumHigh.x + pixel.sumHigh.y + pixel.sumHigh.z));
}

}  // namespace
}  // namespace parhelion
