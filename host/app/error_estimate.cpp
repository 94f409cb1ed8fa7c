#include "app/error_estimate.h"

#include <algorithm>
#include <cmath>

namespace parhelion::app {

std::optional<double> estimateRelativeError(const Film& film) {
    double meanSum = 0, varianceSum = 0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const shared::FilmPixel& pixel = film.pixels[i];
        const double count = static_cast<double>(film.pixelSamples.empty() ? film.samples : film.pixelSamples[i]);
        if (count < 2) return std::nullopt;
        const glm::dvec3 mean = (glm::dvec3(pixel.sumHigh) + glm::dvec3(pixel.sumLow)) / count;
        const glm::dvec3 square = (glm::dvec3(pixel.squareHigh) + glm::dvec3(pixel.squareLow)) / count;
        for (int channel = 0; channel < 3; ++channel) {
            meanSum += mean[channel];
            // Rounding can leave a constant pixel a hair below zero.
            const double spread = square[channel] - mean[channel] * mean[channel];
            varianceSum += (spread < 0.0 ? 0.0 : spread) / (count - 1);  // NaN stays: a sum beyond float
        }
    }
    if (!(meanSum > 0) || !std::isfinite(meanSum) || !std::isfinite(varianceSum)) return std::nullopt;
    const double values = 3.0 * static_cast<double>(film.pixels.size());
    return std::sqrt(varianceSum / values) / (meanSum / values);
}

}  // namespace parhelion::app
