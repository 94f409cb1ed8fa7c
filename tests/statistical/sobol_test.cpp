#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "reference/reference_renderer.h"
#include "reference/sampling/sampler.h"
#include "shared/path_types.h"
#include "support/goodness.h"
#include "support/hand_scene.h"
#include "support/stress.h"

// Owen-scrambled Sobol points: stratified within a pixel, uniform and independent across pixels and vertices.
namespace parhelion::reference {
namespace {

using test::CellTest;
using test::partOf;

double significance() { return sidak(test::kFamilySignificance, 60); }

glm::uvec4 wordsOf(std::uint32_t pixel, std::uint64_t sample, std::uint32_t vertex,
                   std::uint32_t purpose = shared::kDrawScatter) {
    const Stream stream = streamOf(pixel, std::uint32_t(sample), std::uint32_t(sample >> 32), 3);
    return drawStratified(stream, true, vertex, purpose);
}

/// How many of the elementary intervals of size 2^-k are hit by 2^k samples from `first` on, over all splits of k.
int missedIntervals(std::uint32_t pixel, std::uint64_t first, int k, int word) {
    int missed = 0;
    for (int split = 0; split <= k; ++split) {
        std::set<std::uint64_t> hit;
        for (std::uint64_t s = first; s < first + (std::uint64_t(1) << k); ++s) {
            const glm::uvec4 w = wordsOf(pixel, s, 1);
            hit.insert((std::uint64_t(w[word]) >> (32 - split)) << 32 | std::uint64_t(w[word + 1]) >> (32 - k + split));
        }
        missed += (1 << k) - int(hit.size());
    }
    return missed;
}

TEST(Sobol, EveryAlignedBlockOfSamplesIsANet) {
    for (const std::uint32_t pixel : {0u, 1u, 77u, 0xffffffffu})
        for (const int word : {0, 2})
            for (const int k : {0, 1, 4, 8})
                for (const std::uint64_t block : {0u, 1u, 5u})
                    EXPECT_EQ(missedIntervals(pixel, block << k, k, word), 0) << pixel << ' ' << word << ' ' << k;
    EXPECT_EQ(missedIntervals(5, (std::uint64_t(1) << 32) + 64, 6, 0), 0);
    EXPECT_GT(missedIntervals(5, 3, 4, 0), 0);  // a block that is not aligned is none: the test can tell
}

// What makes the hash a nested permutation: bit i of the result depends on bits 0 .. i alone, and flips with bit i.
TEST(Sobol, HashPermutesDigitsWithinTheTree) {
    test::Stress stress(3);
    for (int i = 0; i < 2000; ++i) {
        const std::uint32_t x = stress.word(), seed = stress.word();
        for (int bit = 0; bit < 32; ++bit) {
            const std::uint32_t changed = permuteDigits(x, seed) ^ permuteDigits(x ^ (1u << bit), seed);
            EXPECT_EQ(changed & ((1u << bit) - 1u), 0u);
            EXPECT_NE(changed & (1u << bit), 0u);
        }
    }
}

/// Pairs of words of one sample of many pixels.
CellTest pairsOf(const glm::ivec2& pair, std::uint32_t sample, const glm::dvec4& bends) {
    CellTest cells(64, significance());
    for (std::uint64_t i = 0, n = cells.samplesNeeded(); i < n; ++i) {
        const glm::uvec4 w = test::bent(wordsOf(std::uint32_t(i), sample, 1), bends);
        cells.add(partOf(toUniform<double>(w[pair.x]), 8) * 8 + partOf(toUniform<double>(w[pair.y]), 8));
    }
    return cells;
}

// One sample of many pixels each: what unbiasedness needs.
TEST(Sobol, WordsAreUniformOverPixelsAlsoInPairs) {
    for (const glm::ivec2 pair : {glm::ivec2(0, 1), glm::ivec2(2, 3), glm::ivec2(0, 2), glm::ivec2(1, 3)})
        for (const std::uint32_t sample : {0u, 1u, 6u}) {
            const std::string what = fmt::format("words {} and {} of sample {}", pair.x, pair.y, sample);
            pairsOf(pair, sample, glm::dvec4(0)).expectFit(what);
        }
    for (int word = 0; word < 4; ++word) {
        glm::dvec4 bends(0);
        bends[word] = 0.02;
        pairsOf(word < 2 ? glm::ivec2(0, 1) : glm::ivec2(2, 3), 1, bends)
            .expectMisfit(fmt::format("word {} bent by 2 %", word));
    }
}

TEST(Sobol, LowBitsAreUniform) {
    CellTest spare(64, significance());
    for (std::uint64_t i = 0, n = spare.samplesNeeded(); i < n; ++i) {
        const glm::uvec4 w = wordsOf(std::uint32_t(i / 16), i % 16, 2);
        spare.add(spareBits(w.x, w.y, w.w) >> 18);
    }
    spare.expectFit("spare bits");
}

/// Correlation of one word of two draws, in standard errors, over pixels and the samples of each.
/// Within a pixel the products of two stratified words vary less than independent ones would: the limit is
/// conservative.
double correlation(std::uint32_t vertexStep, std::uint32_t sampleStep, int wordA, int wordB, std::uint32_t purpose) {
    constexpr int kCount = 200'000;
    double sum = 0;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const double a = toUniform<double>(wordsOf(i / 16, i % 16, 1)[wordA]);
        const double b = toUniform<double>(wordsOf(i / 16, i % 16 + sampleStep, 1 + vertexStep, purpose)[wordB]);
        sum += 12 * (a - 0.5) * (b - 0.5);
    }
    return sum / std::sqrt(double(kCount));
}

TEST(Sobol, DrawsOfAPathAreUncorrelated) {
    const double limit = twoSidedThreshold(significance());
    for (const std::uint32_t vertex : {1u, 2u})
        for (const int a : {0, 1})
            for (const int b : {0, 1, 2})
                EXPECT_LT(std::abs(correlation(vertex, 0, a, b, shared::kDrawScatter)), limit) << vertex << a << b;
    for (const int b : {0, 1, 2, 3}) EXPECT_LT(std::abs(correlation(0, 0, 0, b, shared::kDrawLight)), limit) << b;
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 3)})
        EXPECT_LT(std::abs(correlation(0, 0, a, b, shared::kDrawScatter)), limit) << a << b;
    // The seeded defect: a second pair that repeats the first.
    EXPECT_GT(correlation(0, 0, 0, 0, shared::kDrawScatter), limit);
}

/// A floor under a square light, seen from above, and fog if wanted.
CompiledScene litFloor() {
    test::HandScene hand;
    hand.lookAt({0, -1, 0.2f}, {24, 24});
    const std::uint32_t floor = hand.addDiffuse(glm::vec3(0.5f));
    const std::uint32_t lamp = hand.addDiffuse(glm::vec3(0));
    hand.addQuad({-20, -2, 20}, {40, 0, 0}, {0, 0, -40}, floor);
    const std::uint32_t light = hand.addQuad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, lamp);
    hand.addAreaLight(shared::kLightQuad, light, lamp, glm::vec3(5));
    return hand.scene;
}

Film renderWith(const CompiledScene& scene, bool sobol, std::uint64_t samples, std::uint32_t seed) {
    RenderSettings settings;
    settings.sampleCount = samples;
    settings.seed = seed;
    settings.featureSamples = 0;
    settings.quality.sobol = sobol;
    settings.effects = EffectSet::all();
    return render<float>(scene, settings);
}

/// Mean and mean squared error of red against `truth` (or against nothing).
double meanSquaredError(const Film& film, const std::vector<double>& truth) {
    double sum = 0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const double error = film.pixels[i].sumHigh.r / double(film.samples) - truth[i];
        sum += error * error;
    }
    return sum / double(film.pixels.size());
}

TEST(Sobol, RendersTheSameImageWithLessError) {
    const CompiledScene scene = litFloor();
    const Film truth = renderWith(scene, false, 16'384, 11);
    std::vector<double> expected;
    double variance = 0, mean = 0;
    for (const shared::FilmPixel& pixel : truth.pixels) {
        const auto [value, error] = test::estimate(pixel, truth.samples);
        expected.push_back(value);
        variance += error * error;
        mean += value;
    }
    const Film independent = renderWith(scene, false, 64, 1), sobol = renderWith(scene, true, 64, 1);
    // At 64 samples a smooth integrand of the film and the light has its error fall by far more than a factor of 4;
    // the truth has 1/256 of the independent error, which the bound leaves room for.
    EXPECT_LT(meanSquaredError(sobol, expected), 0.25 * meanSquaredError(independent, expected));

    // And without bias: the image means agree. Both deviations from the samples, so too large for Sobol points.
    const Film many = renderWith(scene, true, 1024, 2);
    double other = 0, otherVariance = 0;
    for (const shared::FilmPixel& pixel : many.pixels) {
        const auto [value, error] = test::estimate(pixel, many.samples);
        other += value;
        otherVariance += error * error;
    }
    const double deviation = std::sqrt(variance + otherVariance);
    EXPECT_LT(std::abs(other - mean), twoSidedThreshold(significance()) * deviation);
    EXPECT_LT(deviation * 10, 0.01 * mean);  // a bias of 1 % would be found
}

}  // namespace
}  // namespace parhelion::reference
