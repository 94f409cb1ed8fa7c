#include "reference/reference_renderer.h"

#include <chrono>
#include <mutex>

#include "base/parallel.h"
#include "reference/integrator/features.h"
#include "reference/integrator/film.h"
#include "reference/integrator/path_tracer.h"

namespace parhelion::reference {
namespace {

void addCounters(Counters& sum, const Counters& part) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
}

/// Calls body(pixel on the film, index into the crop, counters) for every pixel of the crop, and sums the counters.
template <typename Body>
void forEachPixel(Film& film, const Body& body) {
    std::mutex mutex;
    const PixelRect crop = film.crop;
    parallelFor(crop.size.y, [&](std::size_t row) {
        Counters counters{};
        for (std::uint32_t x = 0; x < crop.size.x; ++x)
            body(crop.offset + glm::uvec2(x, row), row * crop.size.x + x, counters);
        const std::lock_guard lock(mutex);
        addCounters(film.counters, counters);
    });
}

template <typename Real>
void renderFeatures(const SceneView<Real>& scene, const RenderSettings& settings, Film& film) {
    forEachPixel(film, [&](glm::uvec2 pixel, std::size_t index, Counters&) {
        for (std::uint64_t s = 0; s < settings.featureSamples; ++s)
            addFeature(scene, settings.seed, pixel, s, film.features[index]);
    });
    film.featureSamples = settings.featureSamples;
}

/// Adds samples [first, first + count) to every pixel.
template <typename Real>
void renderPass(const SceneView<Real>& scene, const RenderSettings& settings, std::uint64_t first, std::uint64_t count,
                Film& film) {
    forEachPixel(film, [&](glm::uvec2 pixel, std::size_t index, Counters& counters) {
        NoTrace trace;
        shared::LayerPixel* layers = film.layers.empty() ? nullptr : &film.layers[index * film.depthLayers];
        for (std::uint64_t s = first; s < first + count; ++s)
            accumulate(film.pixels[index],
                       tracePath(scene, settings.quality, settings.seed, pixel, s, counters, trace, layers), counters);
    });
    film.samples += count;
}

}  // namespace

template <typename Real>
Film render(const CompiledScene& scene, const RenderSettings& settings, const std::atomic<bool>* stop,
            const std::function<void(std::uint64_t)>& progress) {
    using Clock = std::chrono::steady_clock;
    // Long enough that starting threads costs nothing, short enough that a stop is soon obeyed.
    constexpr auto kLongPass = std::chrono::milliseconds(250);
    const SceneView<Real> view(scene);
    Film film;
    film.filmSize = scene.filmSize;
    film.crop = {scene.cropOffset, scene.cropSize};
    film.radianceUnit = scene.radianceUnit;
    film.pixels.resize(std::size_t(scene.cropSize.x) * scene.cropSize.y);
    film.features.resize(film.pixels.size());
    film.depthLayers = scene.constants.depthLayers;
    film.layers.resize(film.pixels.size() * film.depthLayers);
    renderFeatures(view, settings, film);
    std::uint64_t passSamples = 1;
    while (film.samples < settings.sampleCount && !(stop && *stop)) {
        const auto begin = Clock::now();
        const std::uint64_t count = std::min(passSamples, settings.sampleCount - film.samples);
        renderPass(view, settings, settings.firstSample + film.samples, count, film);
        if (progress) progress(film.samples);
        if (Clock::now() - begin < kLongPass) passSamples *= 2;
    }
    return film;
}

template <typename Real>
glm::vec<3, Real> tracePath(const CompiledScene& scene, const RenderSettings& settings, glm::uvec2 pixel,
                            std::uint64_t sample, PathTrace* trace) {
    const SceneView<Real> view(scene);
    Counters counters{};
    NoTrace none;
    if (!trace) return tracePath(view, settings.quality, settings.seed, pixel, sample, counters, none);
    return tracePath(view, settings.quality, settings.seed, pixel, sample, counters, *trace);
}

template Film render<float>(const CompiledScene&, const RenderSettings&, const std::atomic<bool>*,
                            const std::function<void(std::uint64_t)>&);
template Film render<double>(const CompiledScene&, const RenderSettings&, const std::atomic<bool>*,
                             const std::function<void(std::uint64_t)>&);
template glm::vec3 tracePath<float>(const CompiledScene&, const RenderSettings&, glm::uvec2, std::uint64_t, PathTrace*);
template glm::dvec3 tracePath<double>(const CompiledScene&, const RenderSettings&, glm::uvec2, std::uint64_t,
                                      PathTrace*);

}  // namespace parhelion::reference
