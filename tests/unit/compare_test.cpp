#include "analysis/compare.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/noisy_image.h"

namespace parhelion {
namespace {

using test::constantImage;
using test::kChannels;
using test::noisyImage;
using test::removeVariances;
using test::scale;

std::string comparisonError(const Image& a, const Image& b) {
    try {
        compareImages(a, b);
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

TEST(CompareImages, EqualImagesDifferInNothing) {
    const Image image = noisyImage({19, 11}, 0.1, 1);
    const ImageComparison comparison = compareImages(image, image);
    EXPECT_EQ(comparison.differing, 0u);
    EXPECT_EQ(comparison.values, 3u * 19 * 11);
    EXPECT_EQ(comparison.meanSquaredError, 0.0);
    EXPECT_EQ(comparison.relativeMse, 0.0);
    EXPECT_EQ(comparison.pixels->z, 0.0);
    EXPECT_EQ(*comparison.channels[2].ratio, 1.0);
    EXPECT_TRUE(comparison.agree());
}

TEST(CompareImages, KnownDifferencesGiveKnownErrors) {
    // Every value of b is 2; one of the 3 * 4 values of a is 5.
    const Image b = constantImage({2, 2}, 2.0f);
    Image a = b;
    a.channels["G"][3] = 5.0f;
    const ImageComparison comparison = compareImages(a, b);
    EXPECT_DOUBLE_EQ(comparison.meanSquaredError, 9.0 / 12);
    EXPECT_DOUBLE_EQ(comparison.meanAbsoluteError, 3.0 / 12);
    EXPECT_DOUBLE_EQ(comparison.maxAbsoluteError, 3.0);
    EXPECT_DOUBLE_EQ(comparison.relativeMseEpsilon, 0.02 * 0.02);
    EXPECT_DOUBLE_EQ(comparison.relativeMse, 9.0 / (4 + 0.0004) / 12);
    EXPECT_DOUBLE_EQ(comparison.channels[1].meanA, 2.75);
    EXPECT_DOUBLE_EQ(*comparison.channels[1].ratio, 1.375);
    EXPECT_EQ(comparison.noise, NoiseSource::none);
    EXPECT_FALSE(comparison.channels[1].ratioConfidence || comparison.pixels);
    EXPECT_FALSE(comparison.agree());
}

TEST(CompareImages, BlackReferenceHasNoRatio) {
    const Image black = constantImage({2, 2}, 0.0f);
    EXPECT_EQ(compareImages(black, black).relativeMse, 0.0);
    const ImageComparison comparison = compareImages(constantImage({2, 2}, 1.0f), black);
    EXPECT_EQ(comparison.relativeMse, std::numeric_limits<double>::infinity());
    EXPECT_FALSE(comparison.channels[0].ratio);
}

TEST(CompareImages, MostlyBlackReferenceScalesByItsMean) {
    Image b = constantImage({10, 1}, 0.0f);
    for (const char* channel : kChannels) b.channels[channel][0] = 10.0f;
    EXPECT_DOUBLE_EQ(compareImages(b, b).relativeMseEpsilon, 1e-4);
}

TEST(CompareImages, CountsWhatIsNotFiniteAndDisagrees) {
    const Image b = constantImage({2, 2}, 1.0f);
    Image a = b;
    a.channels["R"][0] = std::numeric_limits<float>::quiet_NaN();
    a.channels["B"][1] = std::numeric_limits<float>::infinity();
    const ImageComparison comparison = compareImages(a, b);
    EXPECT_EQ(comparison.nonFinite, 2u);
    EXPECT_EQ(comparison.meanSquaredError, 0.0);
    EXPECT_FALSE(comparison.agree());
    EXPECT_NE(describe(comparison).find("not finite: 2"), std::string::npos);
}

TEST(CompareImages, RefusesOtherSizesAndMissingChannels) {
    Image a = constantImage({2, 2}, 1.0f);
    EXPECT_EQ(comparisonError(a, constantImage({2, 3}, 1.0f)),
              "images to compare must have one size, 2 x 2; the second image is 2 x 3");
    const Image b = a;
    a.channels.erase("G");
    EXPECT_EQ(comparisonError(a, b), "images to compare must have channels R, G and B; the first image has no 'G'");
}

TEST(CompareImages, IndependentNoiseAgrees) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const ImageComparison comparison =
            compareImages(noisyImage({64, 48}, 0.2, seed), noisyImage({64, 48}, 0.2, 99 + seed));
        EXPECT_EQ(comparison.noise, NoiseSource::both);
        EXPECT_TRUE(comparison.agree()) << describe(comparison);
    }
}

TEST(CompareImages, OneSidedNoiseAgreesWithTheTruth) {
    Image truth = noisyImage({64, 48}, 0.0, 1);
    removeVariances(truth);
    const Image noisy = noisyImage({64, 48}, 0.2, 5);
    const ImageComparison comparison = compareImages(noisy, truth);
    EXPECT_EQ(comparison.noise, NoiseSource::imageA);
    EXPECT_TRUE(comparison.agree()) << describe(comparison);
    EXPECT_EQ(compareImages(truth, noisy).noise, NoiseSource::imageB);
    EXPECT_DOUBLE_EQ(compareImages(truth, noisy).pixels->z, -comparison.pixels->z);
}

// sqrt(2) * 0.2 / sqrt(64 * 48) = 0.0051 is the standard error of a mean difference; the limit for 3 tests is 5.1 of
// them, and 2.3 more make it certain: 4 %. A single pixel sees 6.6 + 2.3 of 0.28: 252 %.
TEST(CompareImages, GlobalBiasShowsOnlyInTheMean) {
    Image a = noisyImage({64, 48}, 0.2, 1);
    scale(a, 1.04);
    const ImageComparison comparison = compareImages(a, noisyImage({64, 48}, 0.2, 2));
    EXPECT_FALSE(comparison.means->passed());
    EXPECT_TRUE(comparison.pixels->passed());
    EXPECT_FALSE(comparison.agree());
}

TEST(CompareImages, LocalBiasShowsInItsTile) {
    // A tile's standard error is 0.28 / 8 = 0.035; the limit for 144 tests is 5.8 of them, 2.3 more: 29 %.
    Image a = noisyImage({64, 48}, 0.2, 1);
    for (unsigned y = 16; y < 24; ++y)
        for (unsigned x = 40; x < 48; ++x) a.channels["B"][y * 64 + x] *= 1.3f;
    const ImageComparison comparison = compareImages(a, noisyImage({64, 48}, 0.2, 2));
    EXPECT_TRUE(comparison.means->passed());
    EXPECT_FALSE(comparison.tiles->passed());
    EXPECT_EQ(comparison.tiles->channel, "B");
    EXPECT_EQ(comparison.tiles->pixel, glm::uvec2(40, 16));
}

// Weighted by their squared means, 9216 values count like 5000: the ratio is known to 2 %, and 4.9 of that reject.
TEST(CompareImages, SquaredErrorIsTheSumOfBothVariances) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const ImageComparison comparison =
            compareImages(noisyImage({64, 48}, 0.2, seed), noisyImage({64, 48}, 0.1, 99 + seed));
        ASSERT_TRUE(comparison.budget);
        // Means of squares 0.25, 1 and 4.
        EXPECT_NEAR(comparison.budget->expected, 0.05 * 1.75, 1e-6);
        EXPECT_NEAR(comparison.budget->ratio, comparison.meanSquaredError / comparison.budget->expected, 1e-6);
        EXPECT_TRUE(comparison.hasIndependentNoise()) << describe(*comparison.budget);
        EXPECT_EQ(identifierOf(comparison.verdict()), "agree");
        EXPECT_LT(comparison.budget->largestBias, 0.4 * std::sqrt(comparison.budget->expected));
    }
}

TEST(CompareImages, ErrorThatNoRegionShowsAddsToTheNoise) {
    // Half a deviation up in every other pixel, down in the others: 25 % more squared error.
    Image a = noisyImage({64, 48}, 0.2, 1);
    for (const char* channel : kChannels)
        for (std::size_t i = 0; i < 64 * 48; ++i) a.channels[channel][i] *= i % 2 ? 1.1f : 0.9f;
    const Image truth = noisyImage({64, 48}, 1e-9, 3);
    const ImageComparison comparison = compareImages(a, truth);
    EXPECT_TRUE(comparison.agree());
    EXPECT_TRUE(comparison.budget->isMore()) << describe(*comparison.budget);
    EXPECT_EQ(identifierOf(comparison.verdict()), "moreNoise");
    EXPECT_FALSE(comparison.isNoiseAlone());
    EXPECT_GT(comparison.budget->largestBias, 0.1 * std::sqrt(1.75));
}

TEST(CompareImages, OverstatedVariancesAreNotIndependentNoise) {
    Image a = noisyImage({64, 48}, 0.2, 1);
    for (const char* channel : kChannels)
        for (float& variance : a.channels[std::string("variance.") + channel]) variance *= 1.2f;
    const ImageComparison comparison = compareImages(a, noisyImage({64, 48}, 1e-9, 2));
    EXPECT_TRUE(comparison.budget->isLess());
    EXPECT_TRUE(comparison.isNoiseAlone());
    EXPECT_FALSE(comparison.hasIndependentNoise());
}

TEST(CompareImages, CountsTheValuesThatDiffer) {
    const Image b = noisyImage({16, 8}, 0.2, 1);
    Image a = b;
    a.channels["R"][3] *= 1.5f;
    a.channels["B"][9] = std::nextafter(a.channels["B"][9], 0.0f);
    const ImageComparison comparison = compareImages(a, b);
    EXPECT_EQ(comparison.differing, 2u);
    EXPECT_NE(describe(comparison).find("values with different bits: 2 of 384"), std::string::npos);
}

// Shared noise must not be taken off a squared error that it is no part of: the difference is (1e-3 of the values), and
// the bound is that and 1.6 standard errors of its mean square over 3072 pixels, each some 60 % of it: 1 %.
TEST(CompareImages, SystematicDifferenceOfPairedImagesIsBounded) {
    Image a = noisyImage({64, 48}, 0.2, 1);
    const Image b = a;
    scale(a, 1.001);
    const ImageComparison comparison = compareImages(a, b);
    const double difference = std::sqrt(comparison.meanSquaredError);
    EXPECT_GE(comparison.budget->largestBias, difference);
    EXPECT_LE(comparison.budget->largestBias, 1.02 * difference);
}

TEST(CompareImages, RefusesVariancesThatSayNothing) {
    Image a = noisyImage({4, 2}, 0.2, 1);
    const Image b = a;
    a.channels["variance.G"][6] = -0.25f;
    EXPECT_EQ(comparisonError(a, b), "the first image: 'variance.G' must be >= 0; got -0.25 at pixel (2, 1)");
    a.channels.erase("variance.G");
    EXPECT_EQ(
        comparisonError(b, a),
        "the second image has a channel 'variance.R' and no 'variance.G': the variances of R, G and B go together");
}

// Four seeds leave three degrees of freedom: deviations that normal noise would never have are common.
TEST(CompareImages, VariancesFromFewSeedsCountAsEstimates) {
    Image a = constantImage({64, 48}, 1.0f), b = a;
    for (const char* channel : kChannels) b.channels[std::string("variance.") + channel].assign(64 * 48, 0.01f);
    a.channels["G"][7] = 2.0f;  // 10 deviations; a t of 10 at 3 degrees of freedom is as improbable as 3.07
    EXPECT_FALSE(compareImages(a, b).pixels->passed());
    b.attributes["seeds"] = std::int64_t{4};
    EXPECT_NEAR(compareImages(a, b).pixels->z, 3.07, 0.01);
}

TEST(CompareImages, RoundingAloneAgreesAndMoreDoesNot) {
    Image a = noisyImage({16, 16}, 0.0, 1);
    const Image b = a;
    scale(a, 1 + 2e-7);
    EXPECT_TRUE(compareImages(a, b).agree()) << describe(compareImages(a, b));
    scale(a, 1 + 1e-5);
    EXPECT_FALSE(compareImages(a, b).agree());
}

TEST(CompareImages, FewSamplesWidenTheLimits) {
    // z = 8 from a variance known from 3 samples a side is unremarkable: P(|T_4| > 8) = 0.0013.
    Image a = constantImage({16, 16}, 1.0f), b = a;
    for (Image* image : {&a, &b})
        for (const char* channel : kChannels) image->channels[std::string("variance.") + channel].assign(256, 0.01f);
    a.channels["R"][0] += 8 * std::sqrt(0.02f);
    EXPECT_FALSE(compareImages(a, b).pixels->passed());
    for (Image* image : {&a, &b}) image->channels["sampleCount.Y"].assign(256, 3.0f);
    EXPECT_TRUE(compareImages(a, b).pixels->passed());
    EXPECT_NEAR(std::erfc(compareImages(a, b).pixels->z / std::sqrt(2.0)), 0.00132, 1e-4);
}

TEST(CompareImages, RatioIntervalHasTheDeltaMethodsWidth) {
    const ImageComparison comparison = compareImages(noisyImage({64, 48}, 0.2, 1), noisyImage({64, 48}, 0.2, 2));
    for (const ChannelMeans& means : comparison.channels) {
        const auto& interval = *means.ratioConfidence;
        // 1.96 sqrt(2) 0.2 / sqrt(3072) = 0.0100 either side, up to the 1 % by which the means themselves scatter.
        EXPECT_NEAR(interval[1] - interval[0], 0.0200, 4e-4);
        EXPECT_DOUBLE_EQ((interval[0] + interval[1]) / 2, *means.ratio);
    }
}

TEST(ErrorImage, HoldsSignedDifferencesAndDeviates) {
    Image a = constantImage({2, 1}, 1.0f), b = a;
    a.channels["R"] = {1.5f, 0.5f};
    EXPECT_FALSE(errorImage(a, b).has("z.R"));
    for (Image* image : {&a, &b})
        for (const char* channel : kChannels)
            image->channels[std::string("variance.") + channel] = {0.03125f, 0.03125f};
    const Image error = errorImage(a, b);
    EXPECT_EQ(error.channels.at("error.R"), (std::vector<float>{0.5f, -0.5f}));
    EXPECT_EQ(error.channels.at("error.G"), (std::vector<float>{0, 0}));
    EXPECT_NEAR(error.channels.at("z.R")[0], 2.0f, 1e-5f);
    EXPECT_NEAR(error.channels.at("z.R")[1], -2.0f, 1e-5f);
}

}  // namespace
}  // namespace parhelion
