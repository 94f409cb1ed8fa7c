#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/goodness.h"
#include "support/tracked_medium.h"

// Shadow rays against exp(-tau): ratio tracking that turns into delta tracking below a threshold.
namespace parhelion {
namespace {

using test::TrackedMedium;
using test::Tracker;

double significance() { return sidak(test::kFamilySignificance, 60); }

/// Voxels in [0, 1] with empty stretches.
TrackedMedium lumps(float sigma, glm::vec3 from, glm::vec3 to, float slack = 1) {
    const glm::uvec3 n(20, 9, 17);
    std::vector<float> voxels;
    for (unsigned i = 0; i < n.x * n.y * n.z; ++i) {
        const glm::vec3 p(i % n.x, i / n.x % n.y, i / (n.x * n.y));
        voxels.push_back(std::max(0.0f, (std::sin(0.9f * p.x) * std::cos(0.7f * p.y) + std::sin(0.5f * p.z)) / 2));
    }
    return TrackedMedium::grid(sigma, n, voxels, {4, 3, 3}, from, to, slack);
}

RunningMoments shadows(Tracker& tracker, float threshold, std::uint32_t count, int channel = 0) {
    RunningMoments moments;
    for (std::uint32_t i = 0; i < count; ++i) moments.add(double(tracker.transmit(i, threshold)[channel]));
    return moments;
}

/// Samples that find an error of half a percent with probability 0.99, from the variation seen in a pilot.
std::uint32_t samplesFor(Tracker& tracker, float threshold) {
    const RunningMoments pilot = shadows(tracker, threshold, 4096);
    const double variation = std::sqrt(pilot.variance()) / pilot.mean();
    return std::uint32_t(sampleSizeFor(test::kDistortion, variation, significance()));
}

TEST(Transmittance, IsUnbiasedWhateverTheThreshold) {
    for (const float threshold : {0.0f, 0.5f, 1.0f})
        for (const bool stochastic : {true, false}) {
            // Bounds three times too high cost time only.
            const TrackedMedium medium = lumps(0.5f, {0, 0.2f, 0.1f}, {4, 2.7f, 2.9f}, stochastic ? 1 : 3);
            Tracker tracker(medium, stochastic);
            const RunningMoments found = shadows(tracker, threshold, samplesFor(tracker, threshold));
            test::expectMean(found, std::exp(-medium.exact->total()), significance(),
                             "threshold " + std::to_string(threshold));
            EXPECT_EQ(tracker.counters()[shared::kCounterMajorantViolations], 0u);
        }
}

TEST(Transmittance, SeededDefectsAreCaught) {
    const TrackedMedium medium = lumps(0.5f, {0, 0.2f, 0.1f}, {4, 2.7f, 2.9f});
    const double exact = std::exp(-medium.exact->total());
    Tracker dense(medium);
    const std::uint32_t count = samplesFor(dense, 1);
    dense.medium().sigmaMax *= 0.98f;
    EXPECT_FALSE(test::agrees(shadows(dense, 1, count), exact, significance())) << "sigma off by 2 %";
    Tracker tracker(medium);
    RunningMoments unrestored;
    for (std::uint32_t i = 0; i < count; ++i) {
        const float weight = tracker.transmit(i, 1).x;
        unrestored.add(weight > 0 ? 0.99 : 0.0);
    }
    EXPECT_FALSE(test::agrees(unrestored, exact, significance())) << "roulette weights off by 1 %";
}

TEST(Transmittance, OfAHomogeneousMediumIsExact) {
    for (const float depth : {1e-8f, 1e-3f, 1.0f, 20.0f, 80.0f}) {
        const TrackedMedium medium = TrackedMedium::homogeneous(depth, 1);
        Tracker tracker(medium);
        // exp rounds once, relative; the product rounds its argument: 2^-24 (1 + tau).
        EXPECT_NEAR(double(tracker.transmit(0, 1).x) / std::exp(-double(depth)), 1, 0x1p-23 * (1 + double(depth)));
    }
}

TEST(Transmittance, IsUnbiasedInEveryChannel) {  // H36: one of them not extinguished at all
    const glm::vec3 ratio{0, 0.25f, 1};
    for (const float threshold : {0.0f, 0.5f, 1.0f}) {
        const TrackedMedium medium = lumps(3, {0, 0.2f, 0.1f}, {4, 2.7f, 2.9f});
        Tracker tracker(medium);
        tracker.medium().sigmaRatio = ratio;
        tracker.medium().grey = false;
        for (int channel = 0; channel < 3; ++channel)
            test::expectMean(shadows(tracker, threshold, 200'000, channel),
                             std::exp(-double(ratio[channel]) * medium.exact->total()), significance(),
                             "channel " + std::to_string(channel));
    }
}

/// E[beta_c / mean(r)] over the flights that escape, whose expectation is the transmittance of channel c.
void expectFlightsUnbiased(const TrackedMedium& medium, const glm::vec3& ratio, double tau, const std::string& what) {
    Tracker tracker(medium);
    tracker.medium().sigmaRatio = ratio;
    tracker.medium().grey = false;
    for (int channel = 0; channel < 3; ++channel) {
        RunningMoments moments;
        for (std::uint32_t i = 0; i < 600'000; ++i) {
            reference::Throughput<float> throughput;
            const bool escapes = !tracker.fly(i, throughput);
            const float weight = escapes ? throughput.beta[channel] / throughput.meanR() : 0.0f;
            ASSERT_TRUE(std::isfinite(weight));
            // The balance of three channels bounds every weight by three.
            ASSERT_LE(weight, 3.00001f);
            moments.add(double(weight));
        }
        test::expectMean(moments, std::exp(-double(ratio[channel]) * tau), significance(),
                         what + " channel " + std::to_string(channel));
    }
}

TEST(ChromaticFlight, IsUnbiasedInEveryChannel) {  // H36
    const TrackedMedium grid = lumps(3, {0, 0.2f, 0.1f}, {4, 2.7f, 2.9f});
    for (const glm::vec3 ratio : {glm::vec3(0, 0.25f, 1), glm::vec3(1, 0.9f, 0)})
        expectFlightsUnbiased(grid, ratio, grid.exact->total(), "grid");
    expectFlightsUnbiased(TrackedMedium::homogeneous(1.5f, 1), {0, 0.25f, 1}, 1.5, "homogeneous");
}

}  // namespace
}  // namespace parhelion
