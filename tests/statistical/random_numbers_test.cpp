#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "reference/integrator/camera.h"
#include "reference/sampling/sampler.h"
#include "shared/path_types.h"
#include "support/goodness.h"
#include "unit/compile_fixtures.h"

// The counter-based generator and what is drawn from it directly: exponentials and film positions.
namespace parhelion::reference {
namespace {

using test::CellTest;
using test::partOf;

double significance() { return sidak(test::kFamilySignificance, 60); }

/// The draws of sample after sample of pixel after pixel, as a render takes them.
glm::uvec4 wordsOf(std::uint64_t i, std::uint32_t purpose) {
    return draw(pathKey(std::uint32_t(i / 64), std::uint32_t(i % 64), 0, 0), std::uint32_t(i % 3), purpose);
}

TEST(RandomWords, AreUniformAlsoInPairs) {
    for (int first = 0; first < 4; ++first) {
        const int second = (first + 1) % 4;
        const auto run = [&](const glm::dvec4& bends) {
            CellTest cells(64, significance());
            for (std::uint64_t i = 0, n = cells.samplesNeeded(); i < n; ++i) {
                const glm::uvec4 words = test::bent(wordsOf(i, shared::kDrawScatter), bends);
                const auto u = double(toUniform<float>(words[first])), v = double(toUniform<float>(words[second]));
                cells.add(partOf(u, 8) * 8 + partOf(v, 8));
            }
            return cells;
        };
        test::expectFitUnlessBent(fmt::format("words {} and {}", first, second), {first}, 0.02, run);
    }
}

TEST(RandomWords, LowBitsAreUniform) {
    // What the exponentials and the density corners are completed from.
    CellTest spare(64, significance()), corner(64, significance()), defect(64, significance());
    for (std::uint64_t i = 0, n = spare.samplesNeeded(); i < n; ++i) {
        const glm::uvec4 words = wordsOf(i, shared::kDrawFlight);
        const std::uint32_t bits = spareBits(words.x, words.y, words.w);
        spare.add(bits >> 18);
        corner.add(partOf(cornerOffsets<double>(words).z, 64));
        // The second highest for the highest, one time in fifty.
        defect.add((i % 50 == 0 ? (bits & ~(1u << 23)) | (bits << 1 & (1u << 23)) : bits) >> 18);
    }
    spare.expectFit("spare bits");
    corner.expectFit("corner z");
    defect.expectMisfit("one spare bit in fifty is its neighbour");
}

/// Of the 128 bits of the draws for two purposes: how far the most telling one is from agreeing half of the time, in
/// standard errors.
double worstAgreement(std::uint32_t first, std::uint32_t second) {
    constexpr int kCount = 4096;
    std::array<int, 128> same{};
    for (int i = 0; i < kCount; ++i) {
        const glm::uvec4 differences = wordsOf(std::uint64_t(i), first) ^ wordsOf(std::uint64_t(i), second);
        for (int bit = 0; bit < 128; ++bit) same[std::size_t(bit)] += (~differences[bit / 32] >> (bit % 32)) & 1u;
    }
    double worst = 0;
    for (const int count : same) worst = std::max(worst, std::abs(count - kCount / 2.0) / std::sqrt(kCount / 4.0));
    return worst;
}

// Draws of one vertex for two purposes are as good as independent (H75): a shadow ray must not meet its collisions
// where the number that chose its direction says.
TEST(RandomWords, PurposesShareNoBits) {
    std::vector<std::uint32_t> purposes{shared::kDrawCamera, shared::kDrawLight, shared::kDrawScatter,
                                        shared::kDrawAlbedo, shared::kDrawFeature};
    for (std::uint32_t index = 0; index < 6; ++index)
        for (const std::uint32_t kind : {shared::kDrawFlight, shared::kDrawShadow})
            purposes.push_back(kind | index << shared::kDrawIndexShift);
    const double pairs = double(purposes.size() * (purposes.size() - 1) / 2);
    const double limit = twoSidedThreshold(sidak(significance(), std::size_t(128 * pairs)));
    for (std::size_t i = 0; i < purposes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_LT(worstAgreement(purposes[i], purposes[j]), limit) << purposes[i] << ", " << purposes[j];
    // Purposes that differ in their highest bit alone: the naive way to tell them apart.
    EXPECT_GT(worstAgreement(shared::kDrawLight, 0x80000000u | shared::kDrawLight), 2 * limit);
}

using Uniform = std::function<double(std::uint32_t pixel, std::uint32_t sample, std::uint32_t vertex, int word)>;

double uniformOf(std::uint32_t pixel, std::uint32_t sample, std::uint32_t vertex, int word) {
    return toUniform<double>(draw(pathKey(pixel, sample, 0, 0), vertex, shared::kDrawScatter)[word]);
}

/// Correlation of numbers a step apart, in standard errors.
double correlation(const Uniform& uniform, glm::uvec4 step) {
    constexpr int kCount = 200'000;
    double sum = 0;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const std::uint32_t pixel = i % 5000, sample = i / 5000;
        sum += 12 * (uniform(pixel, sample, 1, 0) - 0.5) *
               (uniform(pixel + step.x, sample + step.y, 1 + step.z, int(step.w)) - 0.5);
    }
    // The product of two independent standardised uniforms has mean 0 and deviation 1.
    return sum / std::sqrt(double(kCount));
}

TEST(RandomWords, NeighboursAreUncorrelated) {  // H75
    const double limit = twoSidedThreshold(significance());
    for (const std::uint32_t pixel : {0u, 1u, 2u, 512u})
        for (const std::uint32_t sample : {0u, 1u, 2u})
            for (const std::uint32_t vertex : {0u, 1u})
                for (const std::uint32_t word : {0u, 1u}) {
                    if (pixel + sample + vertex + word == 0) continue;
                    EXPECT_LT(std::abs(correlation(uniformOf, {pixel, sample, vertex, word})), limit)
                        << pixel << ' ' << sample << ' ' << vertex << ' ' << word;
                }
    // The seeded defect: streams keyed by pixel + sample share their numbers with the next pixel.
    const Uniform overlapping = [](std::uint32_t pixel, std::uint32_t sample, std::uint32_t vertex, int word) {
        return uniformOf(pixel + sample, 0, vertex, word);
    };
    EXPECT_GT(correlation(overlapping, {1, 0xffffffffu, 0, 0}), limit);
}

TEST(RandomWords, VarianceOfTheMeanFallsAsOneOverN) {  // H75
    constexpr int kPixels = 4000;
    const double limit = twoSidedThreshold(significance());
    for (const std::uint32_t count : {1u, 4u, 16u, 64u, 256u, 1024u}) {
        RunningMoments means;
        for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
            double sum = 0;
            for (std::uint32_t sample = 0; sample < count; ++sample) sum += uniformOf(pixel, sample, 2, 1);
            means.add(sum / count);
        }
        // A variance from k values has relative deviation sqrt(2 / (k - 1)) when they are normal; less when uniform.
        const double ratio = means.variance() * 12 * count;
        EXPECT_LT(std::abs(ratio - 1), limit * std::sqrt(2.0 / (kPixels - 1))) << count;
    }
}

TEST(Exponentials, FollowTheirDistribution) {
    const auto fit = [](double scale) {
        CellTest cells(64, significance());
        for (std::uint64_t i = 0, n = cells.samplesNeeded(); i < n; ++i) {
            const glm::uvec4 words = wordsOf(i, shared::kDrawFlight);
            cells.add(partOf(-std::expm1(-scale * double(exponential<float>(words.z, words.w >> 8))), 64));
        }
        return cells;
    };
    fit(1).expectFit("exponential");
    fit(0.98).expectMisfit("rate off by 2 %");
}

TEST(Exponentials, ReachBeyondTheGridOf24Bits) {  // H33
    // Given that the upper 24 bits are all ones, the rest of the flight is again exponential, after 24 ln 2.
    CellTest cells(32, significance());
    float longest = 0;
    for (std::uint64_t i = 0, n = cells.samplesNeeded(); i < n; ++i) {
        const float e = exponential<float>(0xffffffffu, wordsOf(i, 7).x >> 8);
        longest = std::max(longest, e);
        cells.add(partOf(-std::expm1(24 * std::log(2.0) - double(e)), 32));
    }
    cells.expectFit("tail");
    EXPECT_GT(longest, 28.0f);
    // The naive form ends at 24 ln 2, and all that lies beyond is lost.
    EXPECT_LT(-std::log(1.0 - double(toUniform<float>(0xffffffffu))), 16.64);
}

/// Film positions about a pixel that is farther from the film's end than the filter reaches.
CellTest filmOffsets(const SceneDescription& description, const std::function<double(double)>& cdf) {
    const CompiledScene compiled = compileScene(description);
    const SceneView<double> view(compiled);
    const glm::uvec2 pixel = compiled.filmSize / 2u;
    // 32 cells end on entries of the table, between which it is linear on purpose.
    CellTest cells(32, significance());
    test::IndependentNumbers numbers(6);
    for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
        const double x = filmPosition(view, pixel, glm::dvec2(numbers.uniform<double>(), 0.5)).x;
        cells.add(partOf(cdf(x - pixel.x - 0.5), 32));
    }
    return cells;
}

TEST(FilmPositions, FollowTheReconstructionFilter) {
    using fixtures::scene;
    SceneDescription tent = scene(), gaussian = scene();
    tent.film.filter = ReconstructionFilter::Tent;
    tent.film.filterRadius = 1.5;
    gaussian.film.filter = ReconstructionFilter::Gaussian;
    gaussian.film.filterStddev = 0.5;
    gaussian.film.filterRadius = 2;
    const auto tentCdf = [](double x) {
        const double y = 1 - std::min(1.0, std::abs(x) / 1.5), half = y * y / 2;
        return x < 0 ? half : 1 - half;
    };
    // exp(-x^2 / 2 s^2) - exp(-8), cut at 4 s.
    const auto gaussianCdf = [](double s) {
        return [s](double x) {
            const auto mass = [s](double y) {
                return s * std::sqrt(std::acos(-1.0) / 2) * std::erf(y / (s * std::sqrt(2.0))) - std::exp(-8.0) * y;
            };
            return 0.5 + 0.5 * mass(std::clamp(x, -4 * s, 4 * s)) / mass(4 * s);
        };
    };
    filmOffsets(tent, tentCdf).expectFit("tent");
    filmOffsets(gaussian, gaussianCdf(0.5)).expectFit("gaussian");
    filmOffsets(gaussian, gaussianCdf(0.98 * 0.5)).expectMisfit("deviation off by 2 %");
    filmOffsets(scene(), [](double x) { return x + 0.5; }).expectFit("box");
}

}  // namespace
}  // namespace parhelion::reference
