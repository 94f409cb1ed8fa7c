#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "analysis/pixel_moments.h"

namespace parhelion {

/// A pixel whose interval is to be judged.
struct JudgedPixel {
    PixelMoments moments;
    double factor = 1;   ///< see VarianceFactors
    glm::uvec2 cell{0};  ///< in a grid of cells of pixels near each other
};

/// Which pixels' 95 % intervals hold. A pixel that has not met its rare bright samples looks as if there were none, so
/// that its own samples cannot tell; those of the pixels around it can:
/// - *regular* pixels, in which no sample has more than a quarter of the variance, must together have a variance of the
///   variance (VOV) below 0.1;
/// - what the *spikes*, the largest samples of the others, bring to the mean of the neighbourhood must be less than a
///   quarter of the pixel's own standard error, and of the median one of regular pixels: else the pixels without spikes
///   are too dark by more than their intervals say.
/// Pixels that are dark (0 +- 0) or whose sums left the range of float are never trusted.
/// @param pixels   their number.
/// @param pixelAt  gives each; called several times.
/// @param grid     cells per axis.
/// @param radius   cells to each side that make up a neighbourhood.
std::vector<bool> trustedPixels(std::size_t pixels, const std::function<JudgedPixel(std::size_t)>& pixelAt,
                                glm::uvec2 grid, std::uint32_t radius);

}  // namespace parhelion
