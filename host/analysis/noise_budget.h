#pragma once

#include <array>
#include <optional>
#include <span>

#include "analysis/image_pair.h"

namespace parhelion {

/// Whether the mean squared error between two images is what their noise makes of it. Two unbiased images differ by the
/// sum of their variances; what is above that is a systematic difference, however it is spread over the pixels.
struct NoiseBudget {
    double expected = 0;                          ///< mean over pixels and channels of both variances
    double ratio = 0;                             ///< mean squared error / expected
    std::array<double, 2> ratioConfidence{0, 0};  ///< of it
    double z = 0;          ///< of mean squared error - expected; infinite where every pixel says the same
    double threshold = 0;  ///< |z| beyond which the error is not that of independent noise
    /// Upper bound of the root mean square over pixels of the systematic difference, one-sided, at the confidence.
    double largestBias = 0;

    /// More than noise: a systematic difference, or variances that are too small.
    bool isMore() const { return z > threshold; }
    /// Less than independent images would have: they share random numbers, so that their noise cancels in part, or the
    /// variances are too large, as those estimated from stratified points or before a filter are.
    bool isLess() const { return z < -threshold; }
};

/// The noise of the noise comes from the spread over pixels of squared error - variances, so that heavy tails and
/// channels that move together count. Absent where the variances are 0 or fewer than two pixels are finite.
/// @param pairs  the channels of the same two images, with variance layers on one side or both.
/// @param significance  of the test.
/// @param confidence  of the interval and the bound.
std::optional<NoiseBudget> noiseBudget(std::span<const ChannelPair> pairs, glm::uvec2 size, double significance,
                                       double confidence);

}  // namespace parhelion
