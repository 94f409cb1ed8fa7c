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

/// Two seconds after a stop is asked for, what is left of a pass is not worth waiting for.
class Patience {
public:
    explicit Patience(const std::atomic<bool>* stop) : stop_(stop) {}

    /// Also starts the clock, when the stop is first seen.
    bool isOver() {
        if (!stop_ || !*stop_) return false;
        const std::int64_t now = Clock::now().time_since_epoch().count();
        std::int64_t began = 0;
        if (began_.compare_exchange_strong(began, now)) return false;
        return Clock::duration(now - began) >= std::chrono::seconds(2);
    }

private:
    using Clock = std::chrono::steady_clock;
    const std::atomic<bool>* stop_;
    std::atomic<std::int64_t> began_ = 0;
};

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

/// Adds samples [first, first + count) to every run of the control pixels.
template <typename Real>
void renderControls(const SceneView<Real>& scene, const RenderSettings& settings, std::uint64_t first,
                    std::uint64_t count, Film& film) {
    parallelFor(film.controls.size(), [&](std::size_t i) {
        ControlPixel& control = film.controls[i];
        const glm::uvec2 inCrop(control.pixel % film.crop.size.x, control.pixel / film.crop.size.x);
        NoTrace trace;
        Counters counters{};  // not the image's
        for (std::uint32_t run = 0; run < shared::kControlRuns; ++run) {
            const std::uint64_t ofRun = std::uint64_t{run + 1} << (32 + shared::kControlShift);
            for (std::uint64_t s = first; s < first + count; ++s)
                accumulate(control.runs[run],
                           tracePath(scene, settings.quality, settings.seed, film.crop.offset + inCrop, s | ofRun,
                                     counters, trace),
                           s == settings.firstSample, counters);
        }
    });
}

/// Adds samples [first, first + count) to every pixel. False where patience was over before all were done.
template <typename Real>
bool renderPass(const SceneView<Real>& scene, const RenderSettings& settings, std::uint64_t first, std::uint64_t count,
                Patience& patience, Film& film) {
    std::atomic<bool> isCutOff = false;
    forEachPixel(film, [&](glm::uvec2 pixel, std::size_t index, Counters& counters) {
        NoTrace trace;
        shared::LayerPixel* layers = film.layers.empty() ? nullptr : &film.layers[index * film.depthLayers];
        for (std::uint64_t s = first; s < first + count && !isCutOff; ++s) {
            accumulate(film.pixels[index],
                       tracePath(scene, settings.quality, settings.seed, pixel, s, counters, trace, layers),
                       s == settings.firstSample, counters);
            if (patience.isOver()) isCutOff = true;
        }
    });
    if (isCutOff) return false;
    renderControls(scene, settings, first, count, film);
    film.samples += count;
    return true;
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
    film.stratified = settings.quality.sobol;
    film.controlTileEdge = settings.controls.tileEdge;
    for (const std::uint32_t pixel : settings.controls.pixels) film.controls.push_back({.pixel = pixel});
    film.features.resize(film.pixels.size());
    film.depthLayers = scene.constants.depthLayers;
    film.layers.resize(film.pixels.size() * film.depthLayers);
    renderFeatures(view, settings, film);
    std::uint64_t passSamples = 1;
    Patience patience(stop);
    struct {
        std::vector<shared::FilmPixel> pixels;
        std::vector<shared::LayerPixel> layers;
    } before;  // the pass under way
    while (film.samples < settings.sampleCount && !(stop && *stop)) {
        const auto begin = Clock::now();
        const std::uint64_t count = std::min(passSamples, settings.sampleCount - film.samples);
        before.pixels = film.pixels;
        before.layers = film.layers;
        if (!renderPass(view, settings, settings.firstSample + film.samples, count, patience, film)) {
            film.pixels = std::move(before.pixels);
            film.layers = std::move(before.layers);
            break;
        }
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
