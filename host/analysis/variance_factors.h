#pragma once

#include <array>
#include <vector>

#include "base/film.h"

namespace parhelion {

/// What the variance of a pixel's mean is of that which independent samples with the same spread would have. Stratified
/// samples do better than independent ones, and nothing in one pixel's samples says by how much; the control pixels do,
/// each of which has been rendered several times over.
class VarianceFactors {
public:
    /// @param film  with as many samples in every pixel of a tile as in its control pixel. Independent samples: all
    ///              factors are 1. Stratified ones without control pixels: also, which bounds the variance from above.
    /// @param useImage  whether the image's own pixel counts as one more run: not for decisions on the image.
    VarianceFactors(const Film& film, bool useImage);

    /// Of the image's total variance, by channel (R, G, B, luminance).
    double ofImage(int channel) const { return ofImage_[static_cast<std::size_t>(channel)]; }
    /// Variance of ofImage(3) over its square: how well the control pixels know it.
    double uncertainty() const { return uncertainty_; }
    /// Near a pixel of the crop: of the variance in the 5 x 5 tiles around it, pulled a little to that of the image.
    double near(glm::uvec2 pixel) const;

private:
    std::array<double, 4> ofImage_{1, 1, 1, 1};
    double uncertainty_ = 0;
    std::uint32_t edge_ = 1;
    glm::uvec2 tiles_{0};
    std::vector<double> ofTile_;
};

}  // namespace parhelion
