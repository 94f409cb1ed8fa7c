#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "render/path_trace_pass.h"
#include "render/specialise.h"

namespace parhelion::render {
namespace {

constexpr double kTargetMs = 150;     // a dispatch: short enough for progress and Ctrl-C
constexpr double kRunAheadMs = 2000;  // how far fast pixels may run ahead of slow ones: the wait after Ctrl-C
constexpr std::uint32_t kMinimumRunAhead = 16;
constexpr std::uint32_t kMinimumBudget = 6000;

/// Lanes driven together. On a CPU the saved paths should stay near the caches; a GPU wants many.
std::uint32_t maximumLanes(const gpu::Device& device) { return device.info().software ? 1u << 17 : 1u << 20; }

std::vector<Batch> batchesOf(glm::uvec2 size, std::uint32_t lanes) {
    const std::uint32_t band = 8 * size.x, pixels = size.x * size.y;
    const std::uint32_t step = std::max(1u, lanes / band) * band;
    std::vector<Batch> batches;
    for (std::uint32_t first = 0; first < pixels; first += step)
        batches.push_back({first, std::min(step, pixels - first)});
    return batches;
}

}  // namespace

struct Renderer::State {
    State(gpu::Device& device_, const CompiledScene& scene_, const RenderSettings& settings_)
        : device(device_),
          scene(scene_),
          settings(settings_),
          constants(specialise(scene_, settings_.effects, settings_.quality)),
          deviceScene(device_, scene_),
          batches(batchesOf(scene_.cropSize, maximumLanes(device_))),
          pass(device_, deviceScene, constants, batches, scene_.constants.depthLayers) {}

    gpu::Device& device;
    const CompiledScene& scene;
    RenderSettings settings;
    gpu::Specialisation constants;
    DeviceScene deviceScene;
    std::vector<Batch> batches;
    PathTracePass pass;

    std::array<std::uint64_t, shared::kCounterCount> counters{};
    std::uint64_t windowStart = 0;  // samples per pixel that earlier windows finished
    std::uint32_t windowSize = 0;   // samples per pixel of this one; 0: to be begun
    std::size_t batch = 0;
    std::uint32_t limit = 0;  // samples that lanes of the batch may begin
    bool restart = true;
    bool stopping = false;
    std::uint32_t loopBudget = 512;
    double msSpent = 0;
    double lastMs = 0;
    int idleDispatches = 0;

    void beginWindow();
    void raiseLimit(std::uint32_t slowest);
    void checkCounters();
    void adaptBudget();
    std::vector<std::uint64_t> samplesByPixel();
    shared::PathArguments arguments(const Batch& running) const;
    double pathsDone() const { return static_cast<double>(counters[shared::kCounterPathsFinished]); }
    double pixels() const { return static_cast<double>(scene.cropSize.x) * scene.cropSize.y; }
    double passMs() const { return pathsDone() > 0 ? msSpent * pixels() / pathsDone() : kTargetMs; }
};

void Renderer::State::beginWindow() {
    const std::uint64_t left = settings.sampleCount - windowStart;
    // One batch: everything in one window, so that no lane ever waits. Several: turns long enough to hide the waits.
    std::uint64_t size = left;
    if (batches.size() > 1)
        size = windowStart == 0 ? 4 : static_cast<std::uint64_t>(std::max(4.0, kRunAheadMs * 2 / passMs()));
    windowSize = static_cast<std::uint32_t>(std::min<std::uint64_t>({size, left, 1u << 30}));
    batch = 0;
    restart = true;
    limit = 0;
}

void Renderer::State::raiseLimit(std::uint32_t slowest) {
    const double ahead = std::clamp(kRunAheadMs / passMs(), double(kMinimumRunAhead), 1e9);
    limit = static_cast<std::uint32_t>(std::min<double>(windowSize, std::max<double>(limit, slowest + ahead)));
}

void Renderer::State::checkCounters() {
    const auto& now = pass.counters();
    if (now[shared::kCounterLoopTruncated] != 0)
        throw RuntimeFailure(fmt::format("the device cut {} shader loops short: the image would be wrong",
                                         now[shared::kCounterLoopTruncated]));
    if (now[shared::kCounterBvhOverflow] != 0)
        throw RuntimeFailure(
            fmt::format("{} rays met more BVH nodes than a dispatch may visit", now[shared::kCounterBvhOverflow]));
    for (std::size_t i = 0; i < counters.size(); ++i)
        if (i != shared::kCounterActiveLanes) counters[i] += now[i];
    // A lane may spend many dispatches on one path, but some lane takes a step in every dispatch.
    const bool idle =
        now[shared::kCounterPathsFinished] + now[shared::kCounterSteps] + now[shared::kCounterVertices] == 0;
    idleDispatches = idle ? idleDispatches + 1 : 0;
    if (idleDispatches > 64) throw RuntimeFailure("the device makes no progress: 64 dispatches without a step");
}

void Renderer::State::adaptBudget() {
    const double factor = std::clamp(kTargetMs / std::max(lastMs, 0.1), 0.25, 2.0);
    loopBudget = static_cast<std::uint32_t>(
        std::clamp(loopBudget * factor, double(kMinimumBudget), double(PathTracePass::kMaximumLoopBudget)));
}

/// Within a window batches, and the pixels of a batch, differ.
std::vector<std::uint64_t> Renderer::State::samplesByPixel() {
    std::vector<std::uint64_t> samples;
    for (std::size_t i = 0; i < batches.size(); ++i) {
        samples.insert(samples.end(), batches[i].laneCount, windowStart + (i < batch ? windowSize : 0));
        if (i != batch || restart) continue;
        const auto done = pass.samplesDone(i);
        std::ranges::transform(done, samples.end() - batches[i].laneCount, [&](auto n) { return windowStart + n; });
    }
    return samples;
}

shared::PathArguments Renderer::State::arguments(const Batch& running) const {
    const std::uint64_t first = settings.firstSample + windowStart;
    return {.filmSize = scene.filmSize,
            .cropOffset = scene.cropOffset,
            .cropSize = scene.cropSize,
            .firstPixel = running.firstPixel,
            .laneCount = running.laneCount,
            .sampleLow = static_cast<std::uint32_t>(first),
            .sampleHigh = static_cast<std::uint32_t>(first >> 32),
            .sampleCount = limit,
            .seed = settings.seed,
            .loopBudget = loopBudget,
            .restart = restart};
}

Renderer::Renderer(gpu::Device& device, const CompiledScene& scene, const RenderSettings& settings)
    : state_(std::make_unique<State>(device, scene, settings)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

bool Renderer::step() {
    State& s = *state_;
    if (s.windowSize == 0) {
        if (s.stopping || s.windowStart >= s.settings.sampleCount) return false;
        s.beginWindow();
        s.raiseLimit(0);
    }
    const Batch& batch = s.batches[s.batch];
    s.lastMs = s.pass.run(s.batch, s.arguments(batch));
    s.restart = false;
    s.msSpent += s.lastMs;
    s.checkCounters();
    const auto done = s.pass.samplesDone(s.batch);
    const std::uint32_t slowest = *std::ranges::min_element(done);
    if (slowest >= s.windowSize) {
        s.restart = true;
        if (++s.batch == s.batches.size()) {
            s.windowStart += s.windowSize;
            s.windowSize = 0;
        } else {
            s.limit = 0;
            s.raiseLimit(0);
        }
    } else {
        s.raiseLimit(slowest);
        s.adaptBudget();
    }
    return s.windowSize != 0 || (!s.stopping && s.windowStart < s.settings.sampleCount);
}

void Renderer::finishEarly() {
    State& s = *state_;
    s.stopping = true;
    // Every batch takes as many samples as the first (H81): only there is it still open how many.
    if (s.batch == 0) s.windowSize = std::min(s.windowSize, s.limit);
}

Progress Renderer::progress() const {
    const State& s = *state_;
    return {s.pathsDone(), s.pixels() * static_cast<double>(s.settings.sampleCount), s.lastMs};
}

Film Renderer::filmSoFar() {
    State& s = *state_;
    Film film;
    film.filmSize = s.scene.filmSize;
    film.crop = {s.scene.cropOffset, s.scene.cropSize};
    film.radianceUnit = s.scene.radianceUnit;
    film.samples = s.windowStart;
    if (s.windowSize != 0) film.pixelSamples = s.samplesByPixel();
    film.pixels = s.pass.film();
    film.depthLayers = s.scene.constants.depthLayers;
    film.layers = s.pass.layers();
    film.counters = s.counters;
    return film;
}

Film Renderer::film() {
    State& s = *state_;
    Film film = filmSoFar();
    film.features = renderFeatures(s.device, s.scene, s.deviceScene, s.settings, s.constants);
    film.featureSamples = s.settings.featureSamples;
    return film;
}

Film render(gpu::Device& device, const CompiledScene& scene, const RenderSettings& settings) {
    Renderer renderer(device, scene, settings);
    while (renderer.step()) {
    }
    return renderer.film();
}

}  // namespace parhelion::render
