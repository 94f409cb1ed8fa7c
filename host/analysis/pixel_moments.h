#pragma once

#include <cstdint>

#include "shared/path_types.h"

namespace parhelion {

/// What a pixel's samples say of the distribution they come from: the luminance's, in units of the film.
struct PixelMoments {
    double samples = 0;
    double mean = 0;
    double variance = 0;  ///< of one sample, unbiased; 0 where rounding is all there is
    double third = 0;     ///< mean cube of the deviations from the mean
    double fourth = 0;    ///< mean fourth power of them
    double largest = 0;
    bool isFinite = true;  ///< all sums are within float

    /// Variance of the estimated variance over its square, as Monte Carlo transport codes judge tallies:
    /// sum (x - m)^4 / (sum (x - m)^2)^2 - 1/n. 0 where the samples do not vary, 1 for less than two.
    /// Source: MCNP6 User's Manual, "Variance of the Variance".
    double varianceOfVariance() const;
    /// Degrees of freedom of Student's distribution whose estimated variance is as uncertain: 2 / VOV, at most n - 1,
    /// at least 1 (Satterthwaite).
    double degreesOfFreedom() const;
    /// The largest sample's share of the sum of all; 0 for a black pixel.
    double largestShare() const;
    /// Nothing but zeros: how bright the pixel is, nobody knows.
    bool isDark() const { return largest == 0 && mean == 0; }
};

PixelMoments momentsOf(const shared::FilmPixel& pixel, std::uint64_t samples);

/// Variance of the mean of one channel's samples if they are independent, in units of the film squared. Where the
/// channel's squares hold nothing but rounding, as if it varied like the luminance; 0 for one sample.
double varianceOfMean(const shared::FilmPixel& pixel, int channel, std::uint64_t samples);

/// Mean of one channel's samples.
double meanOf(const shared::FilmPixel& pixel, int channel, std::uint64_t samples);

}  // namespace parhelion
