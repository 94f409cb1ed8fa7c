#include "analysis/pixel_moments.h"

#include <algorithm>
#include <cmath>

namespace parhelion {
namespace {

/// Below this share of its mean squared, a sample's variance is what rounding to float leaves of 0.
constexpr double kRoundingOfSquares = 0x1p-22;
constexpr double kRoundingOfDeviations = 0x1p-44;  // of powers about the first sample: two roundings, squared

}  // namespace

double PixelMoments::varianceOfVariance() const {
    if (samples < 2) return 1;
    const double spread = variance * (samples - 1) / samples;
    if (!(spread > 0)) return 0;
    return std::max(0.0, fourth / (spread * spread) - 1) / samples;
}

double PixelMoments::degreesOfFreedom() const {
    const double vov = varianceOfVariance();
    return std::max(1.0, vov > 0 ? std::min(samples - 1, 2 / vov) : samples - 1);
}

double PixelMoments::largestShare() const { return mean > 0 ? largest / (mean * samples) : 0; }

PixelMoments momentsOf(const shared::FilmPixel& pixel, std::uint64_t samples) {
    PixelMoments moments;
    if (samples == 0) return moments;
    const double n = static_cast<double>(samples);
    const glm::dvec2 sums = (glm::dvec2(pixel.powerHigh) + glm::dvec2(pixel.powerLow)) / n;
    const glm::dvec3 powers(sums, double{pixel.third} / n);
    const double fourth = double{pixel.fourth} / n, d = powers.x;
    moments.samples = n;
    moments.mean = pixel.pivot + d;
    moments.largest = pixel.largest;
    moments.isFinite = std::isfinite(powers.x + powers.y + powers.z + fourth);
    if (!moments.isFinite) return moments;
    const double spread = powers.y - d * d;
    if (samples < 2 || spread <= kRoundingOfDeviations * moments.mean * moments.mean) return moments;
    moments.variance = spread * n / (n - 1);
    moments.third = powers.z - 3 * d * powers.y + 2 * d * d * d;
    moments.fourth = std::max(spread * spread, fourth - 4 * d * powers.z + 6 * d * d * powers.y - 3 * d * d * d * d);
    return moments;
}

double meanOf(const shared::FilmPixel& pixel, int channel, std::uint64_t samples) {
    return (double{pixel.sumHigh[channel]} + double{pixel.sumLow[channel]}) / static_cast<double>(samples);
}

double varianceOfMean(const shared::FilmPixel& pixel, int channel, std::uint64_t samples) {
    if (samples < 2) return 0;
    const double n = static_cast<double>(samples), mean = meanOf(pixel, channel, samples);
    const double spread = (double{pixel.squareHigh[channel]} + double{pixel.squareLow[channel]}) / n - mean * mean;
    if (!(spread <= kRoundingOfSquares * mean * mean)) return spread / (n - 1);  // NaN stays
    // The squares have lost it; the luminance's powers, about the first sample, have not.
    const PixelMoments moments = momentsOf(pixel, samples);
    return moments.mean > 0 ? moments.variance / n * (mean / moments.mean) * (mean / moments.mean) : 0;
}

}  // namespace parhelion
