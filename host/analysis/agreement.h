#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/compare.h"
#include "analysis/statistics.h"

namespace parhelion {

/// What testAgreement judges by.
struct AgreementOptions {
    double significance = 1e-6;  ///< of each family of tests (means, tiles, pixels); split by Sidak
    double power = 0.99;         ///< with which the printed smallest biases would have been found
    double confidence = 0.95;    ///< of the intervals printed
    double rounding = 0x1p-20;   ///< of a value of 1: 16 float32 roundings; decides only where noise is absent
    /// Pool the noise of an image's pixels instead of comparing whole images: far sharper for few seeds, and right only
    /// for a box filter and unrelated random numbers in neighbouring pixels.
    bool independentPixels = false;
};

/// One family of comparisons, and what it could see.
struct ScaleAgreement {
    LargestDeviation largest;
    double smallestBias = 0;  ///< relative bias it would have found in the region of median noise
};

/// Root mean square over pixels of the bias between both sides, noise removed: negative means below resolution.
/// From b^2 = mean over pixels of products of independent differences, so that no variance has to be subtracted.
struct RmsBias {
    double estimate = 0;  ///< sign(b^2) sqrt|b^2|, as the bounds; the interval is a jackknife's over seeds
    double lower = 0;
    double upper = 0;
};

/// One channel of the image mean.
struct ChannelAgreement {
    std::string channel;
    double meanA = 0;
    double meanB = 0;
    std::optional<RatioInterval> ratio;  ///< absent, as equivalence, when meanB is 0
    /// Smallest d such that the ratio is proven to lie in [1 - d, 1 + d]: two one-sided tests at the significance.
    std::optional<double> equivalence;
    std::optional<RmsBias> rmsBias;  ///< absent for fewer than three seeds a side
};

/// Whether two renderers, given as independent images each, have the same expectation.
struct ImageAgreement {
    std::size_t seedsA = 0;
    std::size_t seedsB = 0;
    std::size_t shared = 0;     ///< images of one side that the other has to the bit: without noise, or not independent
    std::size_t nonFinite = 0;  ///< values that are NaN or infinite in any image: they fail the test
    std::vector<ChannelAgreement> channels;
    ScaleAgreement means;   ///< of the whole image: finds a global bias
    ScaleAgreement tiles;   ///< of squares of 8 x 8 pixels: finds a local one
    ScaleAgreement pixels;  ///< finds gross errors of single pixels

    bool agree() const;
};

/// Tests whether two sets of images, each of one scene with independent seeds, differ by more than their noise. The
/// noise of both sides is estimated from the spread between their images, never floored to a constant; how well it
/// is known counts (Welch's t-test, turned into a normal deviate). Eight seeds a side or more make it sharp.
///
/// @throws InputError for fewer than two images a side, different sizes, or a missing channel R, G or B.
ImageAgreement testAgreement(std::span<const Image> a, std::span<const Image> b, const AgreementOptions& options = {});

/// The same against a reference of which only this is kept: the mean of its images in channels R, G, B, and the
/// variance of that mean, as their spread shows it, in variance.R, .G, .B. Its pixels are taken as independent, as
/// `options.independentPixels` says of the first side; no RMS bias is estimated.
///
/// @param seeds  images behind the reference, 2 or more: seeds - 1 degrees of freedom a pixel.
/// @throws InputError as above, and for missing variance channels.
ImageAgreement testAgreement(std::span<const Image> a, const Image& reference, std::size_t seeds,
                             const AgreementOptions& options = {});

/// The agreement as lines of text.
std::string describe(const ImageAgreement& agreement);

}  // namespace parhelion
