#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/goodness.h"
#include "support/tracked_medium.h"

// Extinction and majorants at their extremes, one medium and one ray at a time.
namespace parhelion {
namespace {

using reference::Throughput;
using test::TrackedMedium;
using test::Tracker;

double significance() { return sidak(test::kFamilySignificance, 20); }

void expectTransmittance(Tracker& tracker, double exact, int count, const std::string& what) {
    RunningMoments flights, shadows;
    for (std::uint32_t i = 0; i < std::uint32_t(count); ++i) {
        flights.add(tracker.fly(i) ? 0.0 : 1.0);
        shadows.add(double(tracker.transmit(i, 0.5f).x));
    }
    test::expectMean(flights, exact, significance(), what + " flights");
    test::expectMean(shadows, exact, significance(), what + " shadows");
    EXPECT_EQ(tracker.counters()[shared::kCounterMajorantViolations], 0u) << what;
}

TEST(EmptyCells, AreJumpedWithoutANumberGoingWrong) {  // H16
    std::vector<float> voxels(64 * 8 * 8, 0.0f);
    const auto through = [&] {
        return TrackedMedium::grid(3, {64, 8, 8}, voxels, {8, 1, 1}, {0, 0.5f, 0.5f}, {8, 0.4f, 0.6f});
    };
    const TrackedMedium empty = through();
    Tracker nothing(empty);
    for (std::uint32_t i = 0; i < 1000; ++i) {
        ASSERT_FALSE(nothing.fly(i));
        ASSERT_EQ(nothing.transmit(i, 1), glm::vec3(1));
    }
    EXPECT_EQ(nothing.counters()[shared::kCounterCollisions], 0u);
    EXPECT_TRUE(std::isinf(1.0f / (3 * 0.0f))) << "the naive step: infinite, and NaN times a weight of 0";
    for (std::size_t i = 0; i < voxels.size(); ++i) voxels[i] = i % 64 >= 24 && i % 64 < 30 ? 1.0f : 0.0f;
    const TrackedMedium some = through();
    Tracker tracker(some);
    expectTransmittance(tracker, std::exp(-some.exact->total()), 400'000, "one cell in eight");
}

TEST(MixedScales, CostWhatTheRaySeesLocally) {  // H15: densities from 1e-8 to 1 of sigma 1e4
    std::vector<float> voxels(64 * 8 * 8, 1e-8f);
    voxels[63] = 1;  // the last voxel of the first row, in the last cell
    const TrackedMedium medium =
        TrackedMedium::grid(1e4f, {64, 8, 8}, voxels, {8, 1, 1}, {0, 0.9f, 0.9f}, {6, 0.9f, 0.9f});
    Tracker tracker(medium);
    constexpr int kPaths = 10'000;
    for (std::uint32_t i = 0; i < kPaths; ++i) tracker.fly(i);
    // 6 cells a ray, and hardly any collision; one bound for the whole grid would take 1e4 * 6 collisions a ray.
    EXPECT_LE(tracker.counters()[shared::kCounterSteps], 7u * kPaths);
    EXPECT_LE(tracker.counters()[shared::kCounterCollisions], std::uint64_t(20));
    Tracker global(medium);
    std::vector<float> bounds(8, 1.0f);
    global.medium().majorants = bounds.data();
    global.fly(0);
    EXPECT_GT(global.counters()[shared::kCounterCollisions], 50'000u);
}

TEST(HotVoxel, HasItsTransmittance) {  // H22
    std::vector<float> voxels(17 * 17 * 17, 0.01f);
    voxels[(8 * 17 + 8) * 17 + 8] = 100;
    for (const glm::vec3 to : {glm::vec3(1, 1, 1), glm::vec3(1, 0.95f, 0.9f)}) {
        const TrackedMedium medium = TrackedMedium::grid(0.1f, glm::uvec3(17), voxels, glm::vec3(1), glm::vec3(0), to);
        Tracker tracker(medium);
        expectTransmittance(tracker, std::exp(-medium.exact->total()), 400'000, "hot voxel");
    }
}

TEST(FlatGrids, AreHomogeneousAlongTheirOnlyVoxel) {  // H23
    const float half = 0.5f;
    for (const glm::uvec3 n : {glm::uvec3(1, 1, 1), glm::uvec3(1, 5, 9), glm::uvec3(8, 1, 1)}) {
        const std::vector<float> voxels(std::size_t(n.x) * n.y * n.z, half);
        const TrackedMedium medium = TrackedMedium::grid(2, n, voxels, glm::vec3(1), {0, 0.1f, 0.2f}, {1, 0.9f, 1});
        EXPECT_NEAR(medium.exact->total(), double(medium.tEnd), 1e-6);
        Tracker tracker(medium);
        expectTransmittance(tracker, std::exp(-double(medium.tEnd)), 200'000, "flat grid");
    }
}

TEST(Majorants, AThousandTimesTooHighCostOnlyTime) {  // H20
    const std::vector<float> voxels{1 / 3.0f, 1};
    const TrackedMedium medium =
        TrackedMedium::grid(0.75f, {1, 1, 2}, voxels, {1, 1, 1}, {0.3f, 0.4f, 0}, {0.3f, 0.4f, 1}, 1000);
    Tracker tracker(medium);
    expectTransmittance(tracker, std::exp(-0.5), 20'000, "majorants x 1000");
}

TEST(NullCollisions, OfProbabilityZeroNeverDivide) {  // H19: density at its bound, for every uniform there is
    reference::Medium<float> grey{}, chromatic{};
    grey.grey = true;
    grey.sigmaRatio = {1, 1, 1};
    chromatic.sigmaRatio = {0.25f, 1, 0};
    for (const float bound : {1.0f, 0.3f, 1e-3f, 1e30f})
        for (std::uint32_t word = 0; word < 1u << 24; ++word) {
            const auto u = float(word) * 0x1p-24f;
            Throughput<float> throughput;
            if (!reference::decideFlight(grey, glm::vec3(bound), bound, u, 0, throughput) ||
                !reference::decideFlight(chromatic, glm::vec3(bound), bound, u, 1, throughput) ||
                !std::isfinite(throughput.beta.x + throughput.r.z))
                FAIL() << "u " << u << " bound " << bound;
        }
    // The naive form weighs the null collision by (1 - q) over its probability, 1 - q.
    const float q = 1;
    EXPECT_TRUE(std::isnan((1 - q) / (1 - q)));
}

TEST(Interpolation, NeverLeavesTheRangeOfItsVoxels) {  // H18: a negative null density otherwise
    reference::Medium<float> medium{};
    medium.resolution = {2, 2, 2};
    medium.cells = {1, 1, 1};
    test::IndependentNumbers numbers(1);
    int above = 0;
    for (int i = 0; i < 200'000; ++i) {
        const float value = 0.5f + numbers.uniform<float>();
        const std::vector<float> voxels(8, value);
        medium.density = voxels.data();
        const glm::vec2 a = numbers.pair<float>();
        const float found = reference::trilinearDensity(medium, 2.0f * glm::vec3(a, numbers.uniform<float>())).x;
        above += found > value;
        // The bound that compileScene builds: value (1 + 2^-20).
        ASSERT_LE(found, value * (1 + 0x1p-20f));
    }
    EXPECT_GT(above, 0) << "without the widened bound this would be a violation";
}

TEST(ThickMedia, NeverDivideByTransmittance) {  // H30: exp(-1000) is 0 in float
    EXPECT_EQ(std::exp(-1000.0f), 0.0f);
    const std::vector<float> voxels(8, 1.0f);
    for (const bool isGrid : {false, true}) {
        const TrackedMedium medium =
            isGrid ? TrackedMedium::grid(1000, {2, 2, 2}, voxels, glm::vec3(1), {0.5f, 0.5f, 0}, {0.5f, 0.5f, 1})
                   : TrackedMedium::homogeneous(1000, 1);
        Tracker tracker(medium);
        tracker.medium().sigmaRatio = {1, 0.5f, 0.1f};
        tracker.medium().grey = false;
        for (std::uint32_t i = 0; i < 2000; ++i) {
            Throughput<float> throughput;
            ASSERT_TRUE(tracker.fly(i, throughput));
            const glm::vec3 weight = throughput.beta / throughput.meanR();
            ASSERT_TRUE(std::isfinite(weight.x + weight.y + weight.z));
            const glm::vec3 shadow = tracker.transmit(i, 0.5f);
            ASSERT_TRUE(std::isfinite(shadow.x + shadow.y + shadow.z));
        }
    }
}

}  // namespace
}  // namespace parhelion
