// What `compare` calls a pair of images, and which limits it passes.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "analysis/compare.h"
#include "support/noisy_image.h"

namespace parhelion {
namespace {

using test::kChannels;
using test::noisyImage;
using test::removeVariances;
using test::scale;
using test::setVariances;

/// Two images, made from one of mean (0.5, 1, 2), noise of 20 % and variances that say so.
struct VerdictCase {
    std::string name;
    std::function<void(Image& a, Image& b)> change;
    std::string verdict;
    bool agree, noiseAlone, independentNoise;

    friend void PrintTo(const VerdictCase& verdict, std::ostream* stream) { *stream << verdict.name; }
};

/// Identical images, and what is identical but for signs.
std::vector<VerdictCase> identicalImages() {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    return {
        {"Identical", [](Image&, Image&) {}, "identical", true, true, false},
        {"IdenticalOfOneVariance",
         [](Image& a, Image& b) {
             for (Image* image : {&a, &b}) setVariances(*image, 0.25f);
         },
         "identical", true, true, false},
        {"IdenticalWithoutVariances",
         [](Image& a, Image& b) {
             for (Image* image : {&a, &b}) removeVariances(*image);
         },
         "identical", true, true, true},
        {"IdenticalOfNoNoise",
         [](Image& a, Image& b) {
             for (Image* image : {&a, &b}) setVariances(*image, 0.0f);
         },
         "identical", true, true, true},
        {"IdenticalWithNan", [](Image& a, Image& b) { a.channels["R"][7] = b.channels["R"][7] = kNan; }, "identical",
         false, false, false},
        {"ZerosOfOtherSign",
         [](Image& a, Image& b) {
             a.channels["G"][7] = 0.0f;
             b.channels["G"][7] = -0.0f;
         },
         "identical", true, true, false},
    };
}

/// Paired noise, noise below what is claimed.
std::vector<VerdictCase> closeImages() {
    return {
        {"FewPixelsDifferLittle", [](Image& a, Image&) { a.channels["G"][7] *= 1.01f; }, "lessNoise", true, true,
         false},
        {"SameRandomNumbers", [](Image& a, Image&) { scale(a, 1 + 1e-6); }, "lessNoise", true, true, false},
        {"SmoothedAfterwards",
         [](Image& a, Image& b) {
             const auto variances = a.channels;
             a = noisyImage(a.size, 0.06, 5);
             b = noisyImage(a.size, 0.2, 6);
             for (const auto& [name, values] : variances)
                 if (name.starts_with("variance")) a.channels[name] = values;
         },
         "lessNoise", true, true, false},
    };
}

std::vector<VerdictCase> distantImages() {
    const auto independent = [](Image& a, Image& b) { b = noisyImage(a.size, 0.2, 9); };
    return {
        {"Independent", independent, "agree", true, true, true},
        {"OneVarianceIsZero",
         [](Image& a, Image& b) {
             b = noisyImage(a.size, 0.0, 9);
             setVariances(b, 0.0f);
         },
         "agree", true, true, true},
        {"RoundingOfNoNoise",
         [](Image& a, Image& b) {
             scale(a, 1 + 1e-6);
             for (Image* image : {&a, &b}) setVariances(*image, 0.0f);
         },
         "agree", true, true, true},
        {"NoNoiseAndADifference",
         [](Image& a, Image& b) {
             scale(a, 1 + 1e-4);
             for (Image* image : {&a, &b}) setVariances(*image, 0.0f);
         },
         "differ", false, false, false},
        {"FewPixelsDifferMuch", [](Image& a, Image&) { a.channels["G"][7] *= 5.0f; }, "differ", false, false, false},
        {"WithoutVariances",
         [=](Image& a, Image& b) {
             independent(a, b);
             for (Image* image : {&a, &b}) removeVariances(*image);
         },
         "noiseUnknown", false, false, false},
    };
}

std::vector<VerdictCase> oddImages() {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    return {
        {"OneValueIsInfinite", [](Image& a, Image&) { a.channels["B"][7] = kInfinity; }, "notFinite", false, false,
         false},
        {"OneVarianceIsInfinite", [](Image&, Image& b) { b.channels["variance.B"][7] = kInfinity; }, "identical", false,
         false, false},
        {"OnePixel",
         [](Image& a, Image& b) {
             a = noisyImage({1, 1}, 0.2, 1);
             b = noisyImage({1, 1}, 0.2, 2);
         },
         "agree", true, true, true},
    };
}

class CompareVerdict : public testing::TestWithParam<VerdictCase> {};

TEST_P(CompareVerdict, SaysWhatTheDifferenceIs) {
    const VerdictCase& expected = GetParam();
    Image a = noisyImage({64, 48}, 0.2, 1), b = a;
    expected.change(a, b);
    for (const bool swapped : {false, true}) {
        const ImageComparison comparison = swapped ? compareImages(b, a) : compareImages(a, b);
        EXPECT_EQ(identifierOf(comparison.verdict()), expected.verdict) << describe(comparison);
        EXPECT_EQ(comparison.agree(), expected.agree) << describe(comparison);
        EXPECT_EQ(comparison.isNoiseAlone(), expected.noiseAlone) << describe(comparison);
        EXPECT_EQ(comparison.hasIndependentNoise(), expected.independentNoise) << describe(comparison);
    }
}

const auto kVerdictName = [](const testing::TestParamInfo<VerdictCase>& info) { return info.param.name; };
INSTANTIATE_TEST_SUITE_P(IdenticalImages, CompareVerdict, testing::ValuesIn(identicalImages()), kVerdictName);
INSTANTIATE_TEST_SUITE_P(CloseImages, CompareVerdict, testing::ValuesIn(closeImages()), kVerdictName);
INSTANTIATE_TEST_SUITE_P(OddImages, CompareVerdict, testing::ValuesIn(oddImages()), kVerdictName);
INSTANTIATE_TEST_SUITE_P(DistantImages, CompareVerdict, testing::ValuesIn(distantImages()), kVerdictName);

}  // namespace
}  // namespace parhelion
