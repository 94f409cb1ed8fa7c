#pragma once

#include <cstdint>
#include <span>

#include "base/film.h"
#include "image/image.h"

namespace parhelion {

/// Values that the 32-bit channels of an image cannot hold.
struct RangeFaults {
    std::uint64_t above = 0;  ///< beyond 3.4e38, here or in the film's sums; written as 3.4e38
    /// Means and variances below 1.2e-38, or of samples whose squares the film could not hold (their variance is
    /// written as an upper bound). Only in pixels that matter: of at least 2^-40 of the brightest mean.
    std::uint64_t below = 0;

    bool any() const { return above > 0 || below > 0; }
};

/// Resolves a film into the channels of an EXR; the arithmetic is in double, rounded once to float32.
///
/// - R, G, B: mean radiance.
/// - variance.R, .G, .B: estimated variance of that mean, (E[x^2] - mean^2) / (n - 1) times its factor, never negative;
///   absent where a pixel has but one sample. The float32 squares limit it to about 2^-24 mean^2 / (n - 1): a constant
///   pixel may show that much.
/// - albedo.R, .G, .B, normal.X, .Y, .Z: means over the feature samples, misses counted as 0.
/// - depth.Z: mean distance of the feature samples that hit a surface, scene units; 0 where none did.
/// - depth0.R, .G, .B, depth1.R, ...: mean radiance by number of scatterings, the last for all above; only where the
///   film has such layers. They sum to R, G, B but for rounding, and for what a sample that was not finite had brought
///   before.
/// - sampleCount.Y: samples of the pixel (float32: exact up to 2^24).
///
/// The image covers film.crop. When that is not the whole film, integer attributes cropX, cropY, filmWidth and
/// filmHeight place it. Feature channels are absent when the film has no feature samples.
/// @param faults  receives the numbers of values out of range.
/// @param varianceFactors  of each pixel: what the variance is of that of independent samples; empty: 1.
/// @throws RuntimeFailure if the film holds no samples.
Image toImage(const Film& film, RangeFaults* faults = nullptr, std::span<const float> varianceFactors = {});

}  // namespace parhelion
