#include "rendering.h"

#include <cmath>

#include "image/film_image.h"
#include "reference/reference_renderer.h"
#include "render/renderer.h"
#include "support/gpu_fixture.h"

namespace parhelion::test {

const char* name(Backend backend) { return backend == Backend::Vulkan ? "Vulkan" : "Reference"; }

Film renderOn(Backend backend, const CompiledScene& scene, std::uint64_t samples, std::uint32_t seed, bool sobol) {
    RenderSettings settings;
    settings.sampleCount = samples;
    settings.seed = seed;
    settings.featureSamples = 0;
    settings.quality.sobol = sobol;
    settings.effects = scene.effects;
    if (backend == Backend::Vulkan) return render::render(testDevice(), scene, settings);
    return reference::render<float>(scene, settings);
}

PixelEstimate imageMean(const Film& film, int channel) {
    double sum = 0, square = 0;
    for (const shared::FilmPixel& pixel : film.pixels) {
        sum += double{pixel.sumHigh[channel]} + double{pixel.sumLow[channel]};
        square += double{pixel.squareHigh[channel]} + double{pixel.squareLow[channel]};
    }
    const double count = double(film.pixels.size()) * double(film.samples);
    const double mean = sum / count;
    return {mean, std::sqrt(std::max(0.0, square / count - mean * mean) / (count - 1))};
}

std::uint64_t countAnomalies(const Film& film) {
    std::uint64_t count = 0;
    for (const std::uint32_t counter :
         {shared::kCounterNonFinite, shared::kCounterMajorantViolations, shared::kCounterBvhOverflow,
          shared::kCounterLoopTruncated, shared::kCounterNegative})
        count += film.counters[counter];
    return count;
}

std::vector<Image> renderSeeds(Backend backend, const CompiledScene& scene, std::uint64_t samples, std::size_t seeds,
                               std::uint32_t firstSeed, bool sobol) {
    std::vector<Image> images;
    for (std::size_t k = 0; k < seeds; ++k)
        images.push_back(toImage(renderOn(backend, scene, samples, firstSeed + static_cast<std::uint32_t>(k), sobol)));
    return images;
}

}  // namespace parhelion::test
