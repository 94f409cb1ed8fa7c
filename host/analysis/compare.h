#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
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

/// How image a differs from image b, over channels R, G and B.
struct ImageComparison {
    std::size_t nonFinite = 0;  ///< values that are NaN or infinite in either image; they enter no other figure
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

    /// No value is non-finite and no family rejects. Without variance layers: the images are equal.
    bool agree() const;
};

/// Compares two images of one size. Noise comes from the channels variance.R, .G, .B (variance of the pixel's mean)
/// where an image has them, with sampleCount.Y - 1 degrees of freedom if it has that too, or `seeds` - 1 by its
/// attribute of that name; an image without them counts as free of noise. Pixels are taken as independent.
/// @throws InputError for different sizes or a missing channel, saying which.
ImageComparison compareImages(const Image& a, const Image& b, const ComparisonOptions& options = {});

/// Image of the differences: error.R, .G, .B = a - b, and z.R, .G, .B where there are variance layers.
/// @throws InputError as compareImages.
Image errorImage(const Image& a, const Image& b, const ComparisonOptions& options = {});

/// One line: z, threshold, where, and whether it passed.
std::string describe(const LargestDeviation& deviation);

/// Two lines: the squared error against the noise, and the systematic difference left.
std::string describe(const NoiseBudget& budget);

/// The comparison as lines of text.
std::string describe(const ImageComparison& comparison);

}  // namespace parhelion
