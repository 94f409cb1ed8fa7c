#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/noise_budget.h"
#include "analysis/statistics.h"
#include "image/image.h"

namespace parhelion {

/// What compareImages judges by.
struct ComparisonOptions {
    double significance = 1e-6;  ///< of each family of z-tests (means, tiles, pixels); split by Sidak
    double confidence = 0.95;    ///< of the interval around each mean ratio
    double rounding = 0x1p-20;   ///< of a value of 1: 16 float32 roundings; decides only where noise is absent
    std::array<std::string, 2> names{"the first image", "the second image"};  ///< what messages call them
};

/// Mean over the image of one channel.
struct ChannelMeans {
    std::string channel;
    double meanA = 0;
    double meanB = 0;
    std::optional<double> ratio;                           ///< meanA / meanB; absent when meanB is 0
    std::optional<std::array<double, 2>> ratioConfidence;  ///< by the delta method; absent without variance layers
    std::optional<double> z;                               ///< of meanA - meanB; absent without variance layers
};

/// The most improbable difference of a family of comparisons.
struct LargestDeviation {
    double z = 0;           ///< signed, a - b
    double threshold = 0;   ///< |z| beyond which the family rejects
    std::size_t tests = 0;  ///< size of the family
    std::string channel;    ///< empty when every difference is 0
    glm::uvec2 pixel{0};    ///< the pixel, or the tile's upper left one

    bool passed() const { return std::abs(z) <= threshold; }
    /// Takes the deviation's place if it is more improbable.
    void consider(const StudentDeviate& deviate, const std::string& itsChannel, glm::uvec2 itsPixel);
};

/// Where the noise estimate of a comparison comes from.
enum class NoiseSource { none, imageA, imageB, both };

/// What a comparison comes to, the first that applies.
enum class ComparisonVerdict {
    identical,     ///< no two values differ: same bits, or zeros of different sign
    notFinite,     ///< some value is NaN or infinite, so that the figures are those of the others
    noiseUnknown,  ///< the values differ, and no variance layers say by how much they may
    differ,        ///< a test of means, tiles or pixels rejects
    moreNoise,     ///< those tests pass, and the squared error is above the sum of both variances
    lessNoise,     ///< ... is below it: paired random numbers, stratified points, a filtered image
    agree,         ///< noise, as independent renders have it, or rounding explains the difference
};

/// The verdict as a word for scripts, spelt as the enumerator.
std::string_view identifierOf(ComparisonVerdict verdict);

/// The source of noise as a word for scripts, spelt as the enumerator.
std::string_view identifierOf(NoiseSource source);

/// How image a differs from image b, over channels R, G and B.
struct ImageComparison {
    std::size_t values = 0;      ///< compared: three a pixel
    std::size_t differing = 0;   ///< of them without the same bits in both images
    std::size_t nonFinite = 0;   ///< of them NaN or infinite, or their variance, in either image: in no other figure
    std::size_t nonFiniteA = 0;  ///< in the first image
    std::size_t nonFiniteB = 0;  ///< in the second
    double meanSquaredError = 0;
    double meanAbsoluteError = 0;
    double maxAbsoluteError = 0;
    double relativeMse = 0;         ///< mean of (a - b)^2 / (b^2 + relativeMseEpsilon)
    double relativeMseEpsilon = 0;  ///< (0.01 median b)^2; of the mean of |b| where the median is 0
    std::vector<ChannelMeans> channels;
    NoiseSource noise = NoiseSource::none;
    /// Families of z-tests, absent without variance layers: of image means (a global bias), of squares of 8 x 8 pixels
    /// (a local one) and of single pixels (gross errors).
    std::optional<LargestDeviation> means, tiles, pixels;
    std::optional<NoiseBudget> budget;  ///< absent without variance layers, or where they are 0

    ComparisonVerdict verdict() const;
    /// No value is non-finite and no family rejects. Without variance layers: the images are equal.
    bool agree() const;
    /// No value is non-finite, and the difference is at most the noise: no more squared error than variance. Where that
    /// sum cannot tell (less noise than expected, none, or a single pixel), no family may reject. Unknown noise
    /// explains nothing but equality.
    bool isNoiseAlone() const;
    /// The squared error is neither above nor below the sum of both variances, as for independent renders with unbiased
    /// variances. Where there is no noise or a single pixel: isNoiseAlone.
    bool hasIndependentNoise() const;
};

/// Compares two images of one size. Noise comes from the channels variance.R, .G, .B (variance of the pixel's mean)
/// where an image has them, with sampleCount.Y - 1 degrees of freedom if it has that too, or `seeds` - 1 by its
/// attribute of that name; an image without them counts as free of noise. Pixels are taken as independent.
/// @throws InputError for different sizes, a missing channel, variances of some channels only, or a negative variance,
///         saying which.
ImageComparison compareImages(const Image& a, const Image& b, const ComparisonOptions& options = {});

/// Image of the differences: error.R, .G, .B = a - b, and z.R, .G, .B where there are variance layers.
/// @throws InputError as compareImages.
Image errorImage(const Image& a, const Image& b, const ComparisonOptions& options = {});

/// One line: z, threshold, where, and whether it passed.
std::string describe(const LargestDeviation& deviation);

/// Two lines: the squared error against the noise, and the systematic difference left.
std::string describe(const NoiseBudget& budget);

/// The comparison as lines of text, the verdict first.
std::string describe(const ImageComparison& comparison);

}  // namespace parhelion
