#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "support/goodness.h"
#include "support/tracked_medium.h"

// Shadow rays against exp(-tau): ratio tracking that turns into delta tracking below a threshold.
namespace parhelion {
namespace {

using test::TrackedMedium;
using test::Tracker;

double significance() { return sidak(test::kFamilySignificance, 60); }

RunningMoments shadows(Tracker& tracker, float threshold, std::uint32_t count, int channel = 0) {
    RunningMoments moments;
    for (std::uint32_t i = 0; i < count; ++i) moments.add(double(tracker.transmit(i, threshold)[channel]));
    return moments;
}

/// Samples that find an error of half a percent with probability 0.99, a fifth more than a pilot says.
std::uint32_t samplesFor(Tracker& tracker, float threshold) {
    const RunningMoments pilot = shadows(tracker, threshold, 16'384);
    const double variation = std::sqrt(pilot.variance()) / pilot.mean();
    return std::uint32_t(1.2 * sampleSizeFor(test::kDistortion, variation, significance()));
}

TEST(Transmittance, IsUnbiasedWhateverTheThreshold) {
    for (const float threshold : {0.0f, 0.5f, 1.0f})
        for (const bool stochastic : {true, false}) {
            // Bounds three times too high cost time only.
            const TrackedMedium medium = TrackedMedium::lumps(0.5f, stochastic ? 1 : 3);
            Tracker tracker(medium, stochastic);
            const RunningMoments found = shadows(tracker, threshold, samplesFor(tracker, threshold));
            test::expectResolvedMean(found, std::exp(-medium.exact->total()), significance(),
                                     fmt::format("threshold {}, stochastic filter {}", threshold, stochastic));
            EXPECT_EQ(tracker.counters()[shared::kCounterMajorantViolations], 0u);
        }
}

TEST(Transmittance, SeededDefectsAreCaught) {
    const TrackedMedium medium = TrackedMedium::lumps(0.5f);
    for (const float threshold : {0.0f, 1.0f}) {
        Tracker tracker(medium);
        const std::uint32_t count = samplesFor(tracker, threshold);
        tracker.medium().sigmaMax *= 0.98f;
        EXPECT_FALSE(test::agrees(shadows(tracker, threshold, count), std::exp(-medium.exact->total()), significance()))
            << "sigma off by 2 %, threshold " << threshold;
    }
}

/// Shadow rays through a bound of 3 mean free paths, of which 0.4 are real: the decisions alone.
/// @param factor  of the numbers that roulette is played with.
RunningMoments decisions(float factor) {
    constexpr float kReal = 0.4f;
    RunningMoments moments;
    test::IndependentNumbers numbers(9);
    // The weights' variation is below that of a ray that lives or dies, sqrt(e^1.2 - 1) = 1.52.
    const auto count = std::uint64_t(sampleSizeFor(test::kDistortion, 1.52, significance()));
    for (std::uint64_t i = 0; i < count; ++i) {
        glm::vec3 weight(1);
        bool isAlive = true;
        for (double depth = 0; isAlive;) {
            depth -= std::log1p(-numbers.uniform<double>());
            if (depth > 3) break;
            isAlive = reference::decideShadow(glm::vec3(kReal), factor * numbers.uniform<float>(), 0.5f, weight);
        }
        moments.add(isAlive ? double(weight.x) : 0.0);
    }
    return moments;
}

TEST(Transmittance, RouletteRestoresWhatItTakes) {
    const double exact = std::exp(-3 * double(0.4f));
    test::expectResolvedMean(decisions(1), exact, significance(), "roulette");
    EXPECT_FALSE(test::agrees(decisions(0.98f), exact, significance())) << "2 % too many survive";
}

TEST(Transmittance, OfAHomogeneousMediumIsExact) {
    for (const float depth : {1e-8f, 1e-3f, 1.0f, 20.0f, 80.0f}) {
        const TrackedMedium medium = TrackedMedium::homogeneous(depth, 1);
        Tracker tracker(medium);
        // exp rounds once, relative; the product rounds its argument: 2^-24 (1 + tau).
        EXPECT_NEAR(double(tracker.transmit(0, 1).x) / std::exp(-double(depth)), 1, 0x1p-23 * (1 + double(depth)));
    }
}

constexpr double kChromaticError = 0.01;  ///< relative, of each channel: found with probability 0.99

using ThreeMoments = std::array<RunningMoments, 3>;
using ThreeWeights = std::function<glm::vec3(std::uint32_t i)>;

ThreeMoments average(const ThreeWeights& weights, std::uint64_t count) {
    ThreeMoments moments;
    for (std::uint64_t i = 0; i < count; ++i) {
        const glm::vec3 weight = weights(std::uint32_t(i));
        for (int channel = 0; channel < 3; ++channel) moments[channel].add(double(weight[channel]));
    }
    return moments;
}

/// Samples that find kChromaticError in the noisiest channel, a fifth more than a pilot says.
std::uint64_t chromaticSamples(const ThreeWeights& weights) {
    double variation = 0;
    for (const RunningMoments& pilot : average(weights, 16'384))
        variation = std::max(variation, std::sqrt(pilot.variance()) / pilot.mean());
    return std::uint64_t(1.2 * sampleSizeFor(kChromaticError, variation, significance()));
}

void expectChannels(const ThreeMoments& found, const glm::vec3& ratio, double tau, const std::string& what) {
    for (int channel = 0; channel < 3; ++channel) {
        const double exact = std::exp(-double(ratio[channel]) * tau);
        test::expectMean(found[channel], exact, significance(), fmt::format("{}, channel {}", what, channel));
        EXPECT_LE(test::resolution(found[channel], significance()), kChromaticError * exact) << what << ' ' << channel;
    }
}

void makeChromatic(Tracker& tracker, const glm::vec3& ratio) {
    tracker.medium().sigmaRatio = ratio;
    tracker.medium().grey = false;
}

int thickest(const glm::vec3& ratio) { return ratio.x > ratio.z ? 0 : 2; }

TEST(Transmittance, IsUnbiasedInEveryChannel) {  // H36: one of them not extinguished at all, which leaves no roulette
    const TrackedMedium medium = TrackedMedium::lumps(1);
    const double tau = medium.exact->total();
    for (const glm::vec3 ratio : {glm::vec3(0, 0.25f, 1), glm::vec3(1, 0.9f, 0.3f)})
        for (const float threshold : {0.0f, 0.5f, 1.0f}) {
            Tracker tracker(medium), defect(medium);
            makeChromatic(tracker, ratio);
            makeChromatic(defect, 0.95f * ratio);
            const ThreeWeights weights = [&](std::uint32_t i) { return tracker.transmit(i, threshold); };
            const std::uint64_t count = chromaticSamples(weights);
            expectChannels(average(weights, count), ratio, tau,
                           fmt::format("threshold {}, ratio of red {}", threshold, ratio.x));
            const auto wrong = average([&](std::uint32_t i) { return defect.transmit(i, threshold); }, count);
            EXPECT_FALSE(test::agrees(wrong[thickest(ratio)], std::exp(-tau), significance())) << "ratios off by 5 %";
        }
}

/// beta_c / mean(r) of flights that escape, whose expectation is the transmittance of channel c.
glm::vec3 escapeWeight(Tracker& tracker, std::uint32_t i) {
    reference::Throughput<float> throughput;
    if (tracker.fly(i, throughput)) return glm::vec3(0);
    return throughput.beta / throughput.meanR();
}

void expectFlightsUnbiased(const TrackedMedium& medium, const glm::vec3& ratio, double tau, const std::string& what) {
    Tracker tracker(medium), defect(medium);
    makeChromatic(tracker, ratio);
    const ThreeWeights weights = [&](std::uint32_t i) {
        const glm::vec3 weight = escapeWeight(tracker, i);
        // The balance of three channels bounds every weight by three; not so where one is not finite.
        EXPECT_TRUE(glm::all(glm::lessThanEqual(weight, glm::vec3(3.00001f)))) << i;
        return weight;
    };
    const std::uint64_t count = chromaticSamples(weights);
    expectChannels(average(weights, count), ratio, tau, what);
    makeChromatic(defect, 0.95f * ratio);
    const auto wrong = average([&](std::uint32_t i) { return escapeWeight(defect, i); }, count);
    EXPECT_FALSE(test::agrees(wrong[thickest(ratio)], std::exp(-tau), significance())) << what << ", ratios off by 5 %";
}

TEST(ChromaticFlight, IsUnbiasedInEveryChannel) {  // H36
    const TrackedMedium grid = TrackedMedium::lumps(1);
    for (const glm::vec3 ratio : {glm::vec3(0, 0.25f, 1), glm::vec3(1, 0.9f, 0)})
        expectFlightsUnbiased(grid, ratio, grid.exact->total(), fmt::format("grid, ratio of red {}", ratio.x));
    expectFlightsUnbiased(TrackedMedium::homogeneous(1.5f, 1), {0, 0.25f, 1}, 1.5, "homogeneous");
}

}  // namespace
}  // namespace parhelion
