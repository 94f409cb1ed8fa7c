#include "image/film_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace parhelion {

namespace {

constexpr const char* kColours[] = {"R", "G", "B"};
constexpr const char* kAxes[] = {"X", "Y", "Z"};

constexpr double kLargest = std::numeric_limits<float>::max(), kLeastNormal = std::numeric_limits<float>::min();

/// Mean squares below this [square of the film's unit] have lost digits or all of their sum: 2^24 times the least float
/// whose digits are all there. Devices may take anything below that one for 0.
constexpr double kLeastMeanSquare = 0x1p-102;

/// Rounds to float what may lie beyond it.
float toChannel(double value, RangeFaults& faults) {
    if (std::abs(value) <= kLargest) return static_cast<float>(value);
    ++faults.above;
    return static_cast<float>(value < 0.0 ? -kLargest : kLargest);
}

/// Fills a channel with value(pixel index).
template <typename Value>
void fillChannel(Image& image, RangeFaults& faults, const std::string& name, const Value& value) {
    std::vector<float>& channel = image.channels[name];
    channel.resize(std::size_t{image.size.x} * image.size.y);
    for (std::size_t i = 0; i < channel.size(); ++i) channel[i] = toChannel(value(i), faults);
}

double samplesOf(const Film& film, std::size_t pixel) {
    return static_cast<double>(film.pixelSamples.empty() ? film.samples : film.pixelSamples[pixel]);
}

/// Mean and variance of the mean of one channel of a film's pixels.
class PixelStatistics {
public:
    PixelStatistics(const Film& film, int channel) : film_(film), channel_(channel) {}

    double mean(std::size_t i) const { return unitMean(i) * film_.radianceUnit; }

    /// @param below  counts a variance of what is at least `darkest` that float cannot tell.
    double varianceOfMean(std::size_t i, double darkest, std::uint64_t& below) const {
        const shared::FilmPixel& pixel = film_.pixels[i];
        const double samples = samplesOf(film_, i);
        const double meanSquare = (double{pixel.squareHigh[channel_]} + double{pixel.squareLow[channel_]}) / samples;
        const double unit = film_.radianceUnit * film_.radianceUnit, others = samples - 1;
        const double spread = meanSquare - unitMean(i) * unitMean(i);
        double variance = (spread < 0.0 ? 0.0 : spread) / others * unit;  // NaN stays: a sum beyond float
        const bool matters = mean(i) > 0.0 && mean(i) >= darkest;
        if (mean(i) > 0.0 && meanSquare < kLeastMeanSquare) {
            below += matters;
            return std::max(variance, 4.0 * kLeastMeanSquare / others * unit);
        }
        // Below 2^-22 of the squared mean it is what rounding leaves of 0.
        const bool isNoise = variance * others <= 0x1p-22 * mean(i) * mean(i);
        if (!matters || isNoise || variance >= kLeastNormal) return variance;
        ++below;
        return std::max<double>(variance, std::numeric_limits<float>::denorm_min());
    }

private:
    double unitMean(std::size_t i) const {
        const shared::FilmPixel& pixel = film_.pixels[i];
        return (double{pixel.sumHigh[channel_]} + double{pixel.sumLow[channel_]}) / samplesOf(film_, i);
    }

    const Film& film_;
    int channel_;
};

/// Means below this share of the brightest one make no difference to an image.
double darkestThatMatters(const Film& film) {
    double brightest = 0.0;
    for (int c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < film.pixels.size(); ++i)
            brightest = std::max(brightest, PixelStatistics(film, c).mean(i));
    return 0x1p-40 * brightest;
}

void addRadiance(Image& image, const Film& film, std::span<const float> varianceFactors, RangeFaults& faults) {
    const double darkest = darkestThatMatters(film);
    for (int c = 0; c < 3; ++c) {
        const PixelStatistics statistics(film, c);
        fillChannel(image, faults, kColours[c], [&](std::size_t i) {
            const double mean = statistics.mean(i);
            faults.below += mean > 0.0 && mean >= darkest && mean < kLeastNormal;
            return mean;
        });
        if (film.samples > 1)
            fillChannel(image, faults, std::string("variance.") + kColours[c], [&](std::size_t i) {
                const double factor = varianceFactors.empty() ? 1.0 : double{varianceFactors[i]};
                return factor * statistics.varianceOfMean(i, darkest, faults.below);
            });
    }
    fillChannel(image, faults, "sampleCount.Y", [&film](std::size_t i) { return samplesOf(film, i); });
}

void addDepthLayers(Image& image, const Film& film, RangeFaults& faults) {
    for (std::uint32_t layer = 0; layer < film.depthLayers; ++layer)
        for (int c = 0; c < 3; ++c)
            fillChannel(image, faults, "depth" + std::to_string(layer) + "." + kColours[c],
                        [&film, layer, c](std::size_t i) {
                            const double n = samplesOf(film, i);
                            const shared::LayerPixel& pixel = film.layers[i * film.depthLayers + layer];
                            return (double{pixel.sumHigh[c]} + double{pixel.sumLow[c]}) / n * film.radianceUnit;
                        });
}

void addFeatures(Image& image, const Film& film, RangeFaults& faults) {
    const double n = static_cast<double>(film.featureSamples);
    for (int c = 0; c < 3; ++c) {
        fillChannel(image, faults, std::string("albedo.") + kColours[c],
                    [&film, n, c](std::size_t i) { return film.features[i].albedo[c] / n; });
        fillChannel(image, faults, std::string("normal.") + kAxes[c],
                    [&film, n, c](std::size_t i) { return film.features[i].normal[c] / n; });
    }
    fillChannel(image, faults, "depth.Z", [&film](std::size_t i) {
        const shared::FeaturePixel& feature = film.features[i];
        return feature.hits > 0 ? double{feature.depth} / feature.hits : 0.0;
    });
}

}  // namespace

Image toImage(const Film& film, RangeFaults* faults, std::span<const float> varianceFactors) {
    RangeFaults found;
    if (film.samples == 0) throw RuntimeFailure("a film without samples has no mean");
    Image image{.size = film.crop.size, .channels = {}, .attributes = {}};
    addRadiance(image, film, varianceFactors, found);
    addDepthLayers(image, film, found);
    if (film.featureSamples > 0 && !film.features.empty()) addFeatures(image, film, found);
    if (faults) *faults = found;
    if (film.crop.size != film.filmSize)
        image.attributes = {{"cropX", std::int64_t{film.crop.offset.x}},
                            {"cropY", std::int64_t{film.crop.offset.y}},
                            {"filmWidth", std::int64_t{film.filmSize.x}},
                            {"filmHeight", std::int64_t{film.filmSize.y}}};
    return image;
}

}  // namespace parhelion
