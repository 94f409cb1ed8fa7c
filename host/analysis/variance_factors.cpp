#include "analysis/variance_factors.h"

#include <algorithm>
#include <cmath>

#include "analysis/pixel_moments.h"
#include "analysis/statistics.h"

namespace parhelion {
namespace {

/// A control pixel's variance as its runs differ, and as their samples would have it if they were independent; both of
/// the mean of one run, times the pixels of the tile.
struct TileVariance {
    std::array<double, 4> among{}, within{};
};

std::uint64_t samplesOf(const Film& film, std::uint32_t pixel) {
    return film.pixelSamples.empty() ? film.samples : film.pixelSamples[pixel];
}

double tileArea(const Film& film, glm::uvec2 tile) {
    const glm::uvec2 from = tile * film.controlTileEdge;
    const glm::uvec2 extent = glm::min(glm::uvec2(film.controlTileEdge), film.crop.size - from);
    return double{static_cast<double>(extent.x)} * extent.y;
}

TileVariance varianceOf(const Film& film, const ControlPixel& control, bool useImage, double area) {
    TileVariance variance;
    const std::uint64_t samples = samplesOf(film, control.pixel);
    std::vector<const shared::FilmPixel*> runs;
    for (const shared::FilmPixel& run : control.runs) runs.push_back(&run);
    if (useImage) runs.push_back(&film.pixels[control.pixel]);
    for (int channel = 0; channel < 4; ++channel) {
        RunningMoments among, within;
        for (const shared::FilmPixel* run : runs) {
            const PixelMoments moments = momentsOf(*run, samples);
            among.add(channel < 3 ? meanOf(*run, channel, samples) : moments.mean);
            within.add(channel < 3 ? varianceOfMean(*run, channel, samples)
                                   : moments.variance / static_cast<double>(samples));
        }
        const auto c = static_cast<std::size_t>(channel);
        // Equal runs differ by rounding.
        const bool differ = among.variance() > 0x1p-46 * among.mean() * among.mean();
        variance.among[c] = differ ? area * among.variance() : 0;
        variance.within[c] = area * within.mean();
    }
    return variance;
}

/// Sum over the tiles within two of `tile`, as far as there are any.
template <typename Value>
double sumAround(glm::uvec2 tile, glm::uvec2 tiles, const Value& value) {
    const glm::uvec2 from = glm::max(tile, glm::uvec2(2)) - 2u, to = glm::min(tile + 3u, tiles);
    double sum = 0;
    for (std::uint32_t y = from.y; y < to.y; ++y)
        for (std::uint32_t x = from.x; x < to.x; ++x) sum += value(std::size_t{y} * tiles.x + x);
    return sum;
}

}  // namespace

VarianceFactors::VarianceFactors(const Film& film, bool useImage) {
    if (!film.stratified || film.controls.empty() || film.samples < 2) return;
    edge_ = film.controlTileEdge;
    tiles_ = (film.crop.size + edge_ - 1u) / edge_;
    std::vector<TileVariance> variances(std::size_t{tiles_.x} * tiles_.y);
    for (const ControlPixel& control : film.controls) {
        const glm::uvec2 tile = glm::uvec2(control.pixel % film.crop.size.x, control.pixel / film.crop.size.x) / edge_;
        variances[std::size_t{tile.y} * tiles_.x + tile.x] = varianceOf(film, control, useImage, tileArea(film, tile));
    }
    for (std::size_t channel = 0; channel < 4; ++channel) {
        double among = 0, within = 0, squares = 0, ofRuns = 0;
        for (const TileVariance& v : variances) among += v.among[channel], within += v.within[channel];
        if (!(within > 0) || !std::isfinite(among)) continue;
        ofImage_[channel] = among / within;
        // As the tiles differ; at least what a variance of so few runs is worth, which is all there is where one tile
        // has most of it: E[s^4] = sigma^4 (1 + 2 / (R - 1)).
        const double runs = shared::kControlRuns + (useImage ? 1.0 : 0.0);
        for (const TileVariance& v : variances) {
            squares += std::pow(v.among[channel] - ofImage_[channel] * v.within[channel], 2);
            ofRuns += 2 / (runs + 1) * v.among[channel] * v.among[channel];
        }
        if (channel == 3 && among > 0) uncertainty_ = std::max(squares, ofRuns) / (among * among);
    }
    constexpr double kPull = 2;  // tiles
    double mean = 0;
    for (const TileVariance& v : variances) mean += v.within[3] / double(variances.size());
    for (std::uint32_t y = 0; y < tiles_.y; ++y)
        for (std::uint32_t x = 0; x < tiles_.x; ++x) {
            const double among = sumAround({x, y}, tiles_, [&](std::size_t i) { return variances[i].among[3]; });
            const double within = sumAround({x, y}, tiles_, [&](std::size_t i) { return variances[i].within[3]; });
            const double all = within + kPull * mean;
            ofTile_.push_back(all > 0 ? (among + kPull * mean * ofImage_[3]) / all : ofImage_[3]);
        }
}

double VarianceFactors::near(glm::uvec2 pixel) const {
    if (ofTile_.empty()) return 1;
    const glm::uvec2 tile = pixel / edge_;
    return ofTile_[std::size_t{tile.y} * tiles_.x + tile.x];
}

}  // namespace parhelion
