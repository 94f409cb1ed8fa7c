#include "image/tone_curve.h"

#include <algorithm>
#include <cmath>

namespace parhelion {

namespace {

constexpr double kShoulder = 0.5;
constexpr double kDesaturation = 0.15;  // per unit of brightness lost; the value of Khronos PBR Neutral

}  // namespace

glm::dvec3 displayColour(const glm::dvec3& radiance) {
    if (glm::any(glm::isnan(radiance))) return {1, 0, 1};
    if (glm::any(glm::isinf(radiance))) return glm::dvec3(1);
    const glm::dvec3 colour = glm::max(radiance, glm::dvec3(0));
    const double peak = std::max({colour.r, colour.g, colour.b});
    if (peak <= kShoulder) return colour;
    const double shownPeak = 1 - 0.25 / peak;
    const double whiteness = 1 - 1 / (1 + kDesaturation * (peak - shownPeak));
    return glm::mix(colour * (shownPeak / peak), glm::dvec3(shownPeak), whiteness);
}

double encodeSrgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace parhelion
