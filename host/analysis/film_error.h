#pragma once

#include <array>
#include <optional>
#include <vector>

#include "analysis/pixel_moments.h"
#include "base/film.h"

namespace parhelion {

/// An estimate and the interval that covers what it estimates 95 times in 100.
struct Interval {
    double value = 0, lower = 0, upper = 0;
};

/// The 95 % interval of one pixel's luminance, in units of the film.
struct PixelInterval {
    double center = 0, halfWidth = 0;

    bool covers(double truth) const { return std::abs(truth - center) <= halfWidth; }
};

/// The interval by Student's distribution, its degrees of freedom lowered to what the variance's own variance leaves of
/// them, its centre moved for skewness: rare bright samples are missing rather than in excess. Never less than what the
/// arithmetic in float may do to a mean, 2^-20 of it. Whether it holds is trustedPixels()'s to say.
/// @param factor  see VarianceFactors.
/// Sources: Johnson 1978, "Modified t Tests and Confidence Intervals for Asymmetrical Populations"; MCNP6 User's
/// Manual.
PixelInterval intervalOf(const PixelMoments& moments, double factor);

/// How wrong an image is. Absolute values are radiance, relative ones shares of 1; every interval is of 95 %.
struct FilmError {
    std::uint64_t samples = 0;     ///< least of a pixel
    std::array<Interval, 4> mean;  ///< of the image: R, G, B, luminance
    /// Root mean square error over pixels and channels, relative to their mean. The interval is that of the error which
    /// this very image has, not of the one that such images have on average.
    Interval rms;
    Interval relativeMse;  ///< mean of error^2 / (pixel^2 + (0.01 median)^2) over pixels and channels
    /// Half widths of the pixels' own intervals relative to their luminance: quantiles 50, 95 and 99 % over those that
    /// can be trusted; 0 where none can.
    std::array<double, 3> pixels{};
    double pixelsWithin = 0;   ///< share of all pixels whose interval can be trusted and is within 1 % of them
    double pixelsTrusted = 0;  ///< share of pixels whose interval can be trusted
    double pixelsDark = 0;     ///< share of pixels that got nothing but zeros
    double pixelsSpiky = 0;    ///< share that is not dark, and cannot be trusted
    /// 95 % quantile over all pixels, those that cannot be trusted being infinitely wrong.
    double worstPixels = 0;
    double varianceOfVariance = 0;  ///< of the image's mean
    /// Where the image's mean would go if the largest sample of all came once more, in half widths of its interval.
    double largestOnceMore = 0;
    /// Exponent of the tail of the samples' deviations, 10 at most: above 3 their variance is finite.
    double tailSlope = 10;
    bool isFinite = true;  ///< no sum has left the range of float

    double meanRelative() const;  ///< half width of the mean's luminance over it
};

/// From the film's own samples; for a film of stratified ones with its control pixels, without which it is an upper
/// bound. Nothing for a film with less than two samples in a pixel, and for a black one.
std::optional<FilmError> estimateFilmError(const Film& film);

/// Only `samples`, `mean`, `rms`, `varianceOfVariance`, `largestOnceMore` and `isFinite`: what takes one pass over the
/// film.
std::optional<FilmError> estimateMeanError(const Film& film);

/// The same of the image, from nothing but the control pixels: a decision that depends on it does not depend on the
/// image's own samples, so that it cannot bias them.
std::optional<FilmError> estimateControlError(const Film& film);

/// What can be said of each pixel, in the order of film.pixels.
struct PixelErrors {
    std::vector<float> halfWidth;  ///< of its 95 % interval of luminance, radiance
    std::vector<float> isTrusted;  ///< 1 or 0
};
PixelErrors estimatePixelErrors(const Film& film);

/// The variance of each pixel's mean is this times that of independent samples, in the order of film.pixels; empty
/// where samples are independent.
std::vector<float> varianceFactorsOf(const Film& film);

}  // namespace parhelion
