#include "analysis/agreement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace parhelion {
namespace {

constexpr glm::uvec2 kSize{48, 40};
constexpr const char* kChannels[] = {"R", "G", "B"};

/// Brightness between 0.1 and 2.1 that varies over the image, as scenes do.
double trueValue(unsigned x, unsigned y, int channel) {
    return 0.1 + 2.0 * x / kSize.x * (0.5 + 0.5 * y / kSize.y) + 0.1 * channel;
}

/// Relative standard deviation of the images' noise.
constexpr double kNoise = 0.1;

/// Images of independent noise, exponentially distributed in a share of the samples, as light that is seldom found is:
/// skewed, of mean trueValue.
std::vector<Image> render(std::size_t count, unsigned seed, double noise = kNoise) {
    std::mt19937 random(seed);
    std::exponential_distribution<double> exponential(1.0);
    std::vector<Image> images(count);
    for (Image& image : images) {
        image.size = kSize;
        for (int c = 0; c < 3; ++c)
            for (unsigned i = 0; i < kSize.x * kSize.y; ++i)
                image.channels[kChannels[c]].push_back(static_cast<float>(trueValue(i % kSize.x, i / kSize.x, c) *
                                                                          (1 + noise * (exponential(random) - 1))));
    }
    return images;
}

/// Multiplies pixels by factor(x, y).
void distort(std::vector<Image>& images, const std::function<double(unsigned, unsigned)>& factor) {
    for (Image& image : images)
        for (const char* channel : kChannels)
            for (unsigned i = 0; i < kSize.x * kSize.y; ++i)
                image.channels[channel][i] *= static_cast<float>(factor(i % kSize.x, i / kSize.x));
}

AgreementOptions withIndependentPixels() {
    AgreementOptions options;
    options.independentPixels = true;
    return options;
}

TEST(Agreement, IndependentNoiseOfTheSameSceneAgrees) {
    for (const bool independent : {false, true})
        for (unsigned trial = 0; trial < 10; ++trial) {
            AgreementOptions options;
            options.independentPixels = independent;
            // The second side is three times as noisy and has fewer images.
            const ImageAgreement agreement =
                testAgreement(render(12, 2 * trial), render(8, 2 * trial + 1, 3 * kNoise), options);
            EXPECT_TRUE(agreement.agree()) << describe(agreement);
        }
}

// Under the null a family rejects with its significance: at 5 %, each of three families in 10 of 200 trials; five
// standard deviations of a binomial count more is 25. Skew makes no test reject more often: it is the same on both
// sides.
TEST(Agreement, RejectsNoMoreOftenThanStated) {
    AgreementOptions options;
    options.significance = 0.05;
    int means = 0, tiles = 0, pixels = 0;
    for (unsigned trial = 0; trial < 200; ++trial) {
        const ImageAgreement agreement =
            testAgreement(render(8, 1000 + 2 * trial), render(8, 1001 + 2 * trial), options);
        means += !agreement.means.largest.passed();
        tiles += !agreement.tiles.largest.passed();
        pixels += !agreement.pixels.largest.passed();
    }
    EXPECT_LE(means, 25);
    EXPECT_LE(tiles, 25);
    EXPECT_LE(pixels, 25);
    EXPECT_GE(means, 1);  // P(none of 200 at 5 %) = 3.5e-5
}

// The standard error of an image mean is 0.1 / sqrt(1920 * 12) * 1.1 (unequal pixels) = 0.07 %, of the difference
// 0.1 %. With 22 degrees of freedom the limit for 3 tests at 1e-6 is 6.9 of them, 2.3 more: 0.95 %.
TEST(Agreement, FindsAGlobalBiasOfOnePercent) {
    std::vector<Image> a = render(12, 1);
    const std::vector<Image> b = render(12, 2);
    distort(a, [](unsigned, unsigned) { return 1.01; });
    const ImageAgreement agreement = testAgreement(a, b);
    EXPECT_FALSE(agreement.means.largest.passed()) << describe(agreement);
    EXPECT_TRUE(agreement.pixels.largest.passed()) << describe(agreement);
    EXPECT_NEAR(agreement.channels[1].ratio->ratio, 1.01, 0.005);  // five standard errors
    EXPECT_GE(*agreement.channels[1].equivalence, 0.01);
}

// A tile's standard error is 0.1 / sqrt(64 * 12) sqrt(2) = 0.5 %; the limit for 90 tests with 22 degrees of freedom is
// 8.7 of them, 2.3 more: 5.6 %. The whole image would move by 0.2 %.
TEST(Agreement, FindsABiasedTile) {
    std::vector<Image> a = render(12, 3);
    distort(a, [](unsigned x, unsigned y) { return x / 8 == 4 && y / 8 == 2 ? 1.06 : 1.0; });
    const ImageAgreement agreement = testAgreement(a, render(12, 4));
    EXPECT_TRUE(agreement.means.largest.passed()) << describe(agreement);
    EXPECT_FALSE(agreement.tiles.largest.passed()) << describe(agreement);
    EXPECT_EQ(agreement.tiles.largest.pixel, glm::uvec2(32, 16));
}

TEST(Agreement, FindsAWrongPixel) {
    std::vector<Image> a = render(12, 5);
    distort(a, [](unsigned x, unsigned y) { return x == 30 && y == 11 ? 1.8 : 1.0; });
    const ImageAgreement agreement = testAgreement(a, render(12, 6));
    EXPECT_FALSE(agreement.pixels.largest.passed()) << describe(agreement);
    EXPECT_EQ(agreement.pixels.largest.pixel, glm::uvec2(30, 11));
}

TEST(Agreement, IndependentPixelsSharpenFewSeeds) {
    std::vector<Image> a = render(2, 7);
    const std::vector<Image> b = render(2, 8);
    distort(a, [](unsigned, unsigned) { return 1.02; });
    const ImageAgreement plain = testAgreement(a, b), pooled = testAgreement(a, b, withIndependentPixels());
    EXPECT_TRUE(plain.means.largest.passed());
    EXPECT_FALSE(pooled.means.largest.passed()) << describe(pooled);
    EXPECT_LT(pooled.means.smallestBias, 0.05 * plain.means.smallestBias);
}

// The promise that is printed: a bias of that size is found 99 times in 100. Four in five trials is what a promise made
// from one noisy noise estimate keeps at least; half the bias is found far less often than always.
TEST(Agreement, FindsTheSmallestBiasItPrints) {
    int found = 0, foundHalf = 0;
    constexpr int kTrials = 40;
    for (unsigned trial = 0; trial < kTrials; ++trial) {
        const std::vector<Image> b = render(4, 200 + 2 * trial), unbiased = render(4, 201 + 2 * trial);
        const double bias = testAgreement(unbiased, b, withIndependentPixels()).means.smallestBias;
        std::vector<Image> a = unbiased;
        distort(a, [bias](unsigned, unsigned) { return 1 + bias; });
        found += !testAgreement(a, b, withIndependentPixels()).means.largest.passed();
        a = unbiased;
        distort(a, [bias](unsigned, unsigned) { return 1 + bias / 2; });
        foundHalf += !testAgreement(a, b, withIndependentPixels()).means.largest.passed();
    }
    EXPECT_GE(found, kTrials * 4 / 5);
    EXPECT_LE(foundHalf, kTrials / 2);
}

// The squared bias is uncertain by (1.1 * 0.14)^2 sqrt(2 / (16 * 15 * 1920)) = 5e-5; a jackknife says up to sqrt(2)
// times that, and 2.1 of those are 1.5e-4: below (0.5 * 0.04)^2, with room.
TEST(Agreement, RmsBiasSeesAPatternThatAveragesOut) {
    std::vector<Image> a = render(16, 9);
    const std::vector<Image> b = render(16, 10);
    const ImageAgreement same = testAgreement(a, b);
    distort(a, [](unsigned x, unsigned y) { return (x + y) % 2 == 0 ? 1.04 : 0.96; });
    const ImageAgreement agreement = testAgreement(a, b);
    EXPECT_TRUE(agreement.agree()) << describe(agreement);
    double square = 0;
    for (unsigned i = 0; i < kSize.x * kSize.y; ++i)
        square += std::pow(0.04 * trueValue(i % kSize.x, i / kSize.x, 1), 2);
    const double truth = std::sqrt(square / (kSize.x * kSize.y));
    EXPECT_LT(agreement.channels[1].rmsBias->lower, truth);
    EXPECT_GT(agreement.channels[1].rmsBias->upper, truth);
    EXPECT_GT(agreement.channels[1].rmsBias->lower, 0.5 * truth);
    EXPECT_LT(same.channels[1].rmsBias->lower, 0.0);
    EXPECT_LT(same.channels[1].rmsBias->upper, 0.5 * truth);
}

TEST(Agreement, NoiselessImagesMustBeEqualButForRounding) {
    const std::vector<Image> b = render(2, 1, 0.0);
    std::vector<Image> a = b;
    EXPECT_TRUE(testAgreement(a, b).agree());
    distort(a, [](unsigned, unsigned) { return 1 + 2e-7; });
    EXPECT_TRUE(testAgreement(a, b).agree()) << describe(testAgreement(a, b));
    distort(a, [](unsigned x, unsigned) { return x == 0 ? 1.0001 : 1; });
    EXPECT_FALSE(testAgreement(a, b).agree());
}

TEST(Agreement, ImagesOnBothSidesAreNoEvidence) {
    const std::vector<Image> b = render(3, 1);
    std::vector<Image> a = render(3, 2);
    EXPECT_EQ(testAgreement(a, b).shared, 0u);
    a[1] = b[2];
    EXPECT_EQ(testAgreement(a, b).shared, 1u);
    EXPECT_NE(describe(testAgreement(b, b)).find("identical on both sides: 3 images"), std::string::npos);
}

TEST(Agreement, NonFiniteValuesFail) {
    std::vector<Image> a = render(2, 1);
    a[1].channels["G"][7] = std::numeric_limits<float>::quiet_NaN();
    const ImageAgreement agreement = testAgreement(a, render(2, 2));
    EXPECT_EQ(agreement.nonFinite, 1u);
    EXPECT_FALSE(agreement.agree());
    EXPECT_NE(describe(agreement).find("not finite: 1"), std::string::npos);
}

TEST(Agreement, RefusesWhatItCannotCompare) {
    std::vector<Image> two = render(2, 1), mixed = two;
    EXPECT_THROW(testAgreement(render(1, 1), two), InputError);
    EXPECT_THROW(testAgreement(two, {}), InputError);
    mixed[1].size = {24, 80};
    EXPECT_THROW(testAgreement(two, mixed), InputError);
    mixed = two;
    mixed[1].channels.erase("B");
    EXPECT_THROW(testAgreement(two, mixed), InputError);
}

}  // namespace
}  // namespace parhelion
