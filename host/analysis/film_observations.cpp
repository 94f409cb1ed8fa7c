#include "analysis/film_observations.h"

namespace parhelion {
namespace {

constexpr std::uint32_t kCellEdge = 8;  // pixels

}  // namespace

Observations observeImage(const Film& film, const VarianceFactors& factors) {
    Observations observations{.all = {}, .grid = (film.crop.size + kCellEdge - 1u) / kCellEdge};
    observations.all.reserve(film.pixels.size());
    const std::uint32_t width = film.crop.size.x;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const glm::uvec2 pixel(i % width, i / width);
        observations.all.push_back({.pixel = &film.pixels[i],
                                    .samples = film.pixelSamples.empty() ? film.samples : film.pixelSamples[i],
                                    .factor = factors.near(pixel),
                                    .weight = 1,
                                    .cell = pixel / kCellEdge});
    }
    return observations;
}

Observations observeControls(const Film& film, const VarianceFactors& factors) {
    const std::uint32_t edge = film.controlTileEdge;
    Observations observations{.all = {}, .grid = (film.crop.size + edge - 1u) / edge, .radius = 2};
    const double all = static_cast<double>(film.pixels.size());
    double weights = 0;
    for (const ControlPixel& control : film.controls) {
        const glm::uvec2 pixel(control.pixel % film.crop.size.x, control.pixel / film.crop.size.x), cell = pixel / edge;
        const glm::uvec2 extent = glm::min(glm::uvec2(edge), film.crop.size - cell * edge);
        const double weight = static_cast<double>(extent.x * extent.y) / shared::kControlRuns;
        const std::uint64_t samples = film.pixelSamples.empty() ? film.samples : film.pixelSamples[control.pixel];
        for (const shared::FilmPixel& run : control.runs) {
            observations.all.push_back({&run, samples, factors.near(pixel), weight, cell});
            weights += weight;
        }
    }
    for (Observation& observation : observations.all) observation.weight *= all / weights;
    return observations;
}

}  // namespace parhelion
