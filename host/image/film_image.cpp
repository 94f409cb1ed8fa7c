#include "image/film_image.h"

#include <algorithm>

namespace parhelion {

namespace {

constexpr const char* kColours[] = {"R", "G", "B"};
constexpr const char* kAxes[] = {"X", "Y", "Z"};

/// Fills a channel with value(pixel index).
template <typename Value>
void fillChannel(Image& image, const std::string& name, const Value& value) {
    std::vector<float>& channel = image.channels[name];
    channel.resize(std::size_t{image.size.x} * image.size.y);
    for (std::size_t i = 0; i < channel.size(); ++i) channel[i] = static_cast<float>(value(i));
}

void addRadiance(Image& image, const Film& film) {
    const double n = static_cast<double>(film.samples);
    for (int c = 0; c < 3; ++c) {
        const auto mean = [&film, n, c](std::size_t i) {
            const shared::FilmPixel& pixel = film.pixels[i];
            return (double{pixel.sumHigh[c]} + double{pixel.sumLow[c]}) / n;
        };
        const auto varianceOfMean = [&film, &mean, n, c](std::size_t i) {
            const shared::FilmPixel& pixel = film.pixels[i];
            const double meanSquare = (double{pixel.squareHigh[c]} + double{pixel.squareLow[c]}) / n;
            return std::max(0.0, meanSquare - mean(i) * mean(i)) / (n - 1);
        };
        fillChannel(image, kColours[c], mean);
        if (film.samples > 1) fillChannel(image, std::string("variance.") + kColours[c], varianceOfMean);
    }
    fillChannel(image, "sampleCount.Y", [n](std::size_t) { return n; });
}

void addDepthLayers(Image& image, const Film& film) {
    const double n = static_cast<double>(film.samples);
    for (std::uint32_t layer = 0; layer < film.depthLayers; ++layer)
        for (int c = 0; c < 3; ++c)
            fillChannel(image, "depth" + std::to_string(layer) + "." + kColours[c],
                        [&film, n, layer, c](std::size_t i) {
                            const shared::LayerPixel& pixel = film.layers[i * film.depthLayers + layer];
                            return (double{pixel.sumHigh[c]} + double{pixel.sumLow[c]}) / n;
                        });
}

void addFeatures(Image& image, const Film& film) {
    const double n = static_cast<double>(film.featureSamples);
    for (int c = 0; c < 3; ++c) {
        fillChannel(image, std::string("albedo.") + kColours[c],
                    [&film, n, c](std::size_t i) { return film.features[i].albedo[c] / n; });
        fillChannel(image, std::string("normal.") + kAxes[c],
                    [&film, n, c](std::size_t i) { return film.features[i].normal[c] / n; });
    }
    fillChannel(image, "depth.Z", [&film](std::size_t i) {
        const shared::FeaturePixel& feature = film.features[i];
        return feature.hits > 0 ? double{feature.depth} / feature.hits : 0.0;
    });
}

}  // namespace

Image toImage(const Film& film) {
    if (film.samples == 0) throw RuntimeFailure("a film without samples has no mean");
    Image image{.size = film.crop.size, .channels = {}, .attributes = {}};
    addRadiance(image, film);
    addDepthLayers(image, film);
    if (film.featureSamples > 0 && !film.features.empty()) addFeatures(image, film);
    if (film.crop.size != film.filmSize)
        image.attributes = {{"cropX", std::int64_t{film.crop.offset.x}},
                            {"cropY", std::int64_t{film.crop.offset.y}},
                            {"filmWidth", std::int64_t{film.filmSize.x}},
                            {"filmHeight", std::int64_t{film.filmSize.y}}};
    return image;
}

}  // namespace parhelion
