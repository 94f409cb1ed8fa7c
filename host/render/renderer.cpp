#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "render/path_trace_pass.h"
#include "render/snapshot.h"
#include "render/specialise.h"

namespace parhelion::render {
namespace {

constexpr double kTargetMs = 150;     // a dispatch: short enough for progress and Ctrl-C
constexpr double kRunAheadMs = 2000;  // how far fast pixels may run ahead of slow ones
constexpr std::uint32_t kMinimumRunAhead = 16;
constexpr double kSnapshotMs = 4000;  // between snapshots, each of which costs every lane half a dispatch
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

/// Turns after which a path is stuck: at one point of a ray it may meet each null face twice, on its way in and out.
std::uint32_t stallLimit(const CompiledScene& scene) {
    const auto isNull = [&](std::uint32_t shape) { return (scene.shapes[shape].flags & shared::kShapeNull) != 0; };
    const shared::SceneConstants& c = scene.constants;
    std::uint64_t faces = 0;
    for (std::uint32_t i = 0; i < c.quadCount; ++i) faces += isNull(c.quads[i].shape);
    for (std::uint32_t i = 0; i < c.sphereCount; ++i) faces += isNull(c.spheres[i].shape);
    for (std::uint32_t i = 0; i < c.boxCount; ++i) faces += isNull(c.boxes[i].shape);
    for (std::uint32_t i = 0; i < c.triangleCount; ++i)
        faces += isNull(std::bit_cast<std::uint32_t>(scene.triangles[std::size_t{shared::kTriangleTexels} * i].w));
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(shared::kMaximumStall + 2 * faces, ~0u - 1));
}

}  // namespace

struct Renderer::State {
    using Clock = std::chrono::steady_clock;

    State(gpu::Device& device_, const CompiledScene& scene_, const RenderSettings& settings_)
        : device(device_),
          scene(scene_),
          settings(settings_),
          constants(specialise(scene_, settings_.effects, settings_.quality)),
          deviceScene(device_, scene_),
          batches(batchesOf(scene_.cropSize, maximumLanes(device_))),
          pass(device_, deviceScene, constants, batches, scene_.constants.depthLayers),
          stuckAfter(stallLimit(scene_)) {}

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
    std::uint32_t pauseAt = 0;  // samples of the window at which `next` is taken
    Snapshot last, next;        // the last moment when all pixels had the same samples, and the one under way
    std::optional<Clock::time_point> stopBy;  // when a render that is to finish early is cut off
    std::uint32_t stuckAfter;                 // turns
    std::uint32_t loopBudget = 512;
    double msSpent = 0;
    double lastMs = 0;

    void beginWindow();
    void raiseLimit(std::uint32_t slowest);
    void checkCounters();
    void adaptBudget();
    void takeSnapshot(std::span<const std::uint32_t> done, std::uint32_t slowest);
    bool isCutOff() const { return stopBy && Clock::now() >= *stopBy; }
    bool hasMore() const { return windowSize != 0 || (!stopBy && windowStart < settings.sampleCount); }
    std::uint64_t featureSamples();
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
        size = std::max(std::clamp<std::uint64_t>(windowStart, 1, 4),
                        windowStart == 0 ? 1 : static_cast<std::uint64_t>(kRunAheadMs * 2 / passMs()));
    windowSize = static_cast<std::uint32_t>(std::min<std::uint64_t>({size, left, 1u << 30}));
    batch = 0;
    restart = true;
    limit = 0;
    pauseAt = batches.size() > 1 ? windowSize : 1;
}

void Renderer::State::raiseLimit(std::uint32_t slowest) {
    // At first no further than the slowest has come: what is not in a snapshot is lost when the render is stopped.
    const double least = std::clamp(double(slowest), 1.0, double(kMinimumRunAhead));
    const double ahead = pathsDone() > 0 ? std::clamp(kRunAheadMs / passMs(), least, 1e9) : least;
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
    if (now[shared::kCounterStuck] != 0)
        throw RuntimeFailure(fmt::format(
            "{} of the paths under way make no progress, the first being sample {} of pixel ({}, {}): more than {} "
            "turns "
            "at one point of a ray, in boundaries or collisions that never end. Nothing was written. This is a fault "
            "of "
            "the renderer, or of distances and densities that 32-bit floats cannot tell apart; please report it with "
            "the scene",
            now[shared::kCounterStuck], settings.firstSample + windowStart + now[shared::kCounterStuckSample],
            now[shared::kCounterStuckX], now[shared::kCounterStuckY], stuckAfter));
    for (std::size_t i = 0; i < counters.size(); ++i)
        if (i != shared::kCounterActiveLanes) counters[i] += now[i];
}

void Renderer::State::adaptBudget() {
    const double factor = std::clamp(kTargetMs / std::max(lastMs, 0.1), 0.25, 2.0);
    loopBudget = static_cast<std::uint32_t>(
        std::clamp(loopBudget * factor, double(kMinimumBudget), double(PathTracePass::kMaximumLoopBudget)));
}

/// Keeps the pixels that have just the samples of the next snapshot. Lanes stop there for the rest of a dispatch, so
/// that each pixel is seen. The snapshot is done once all pixels have come as far, in all batches.
void Renderer::State::takeSnapshot(std::span<const std::uint32_t> done, std::uint32_t slowest) {
    if (pauseAt == 0) return;
    const auto film = pass.film(batch);
    const auto layers = pass.layers(batch);
    for (std::size_t i = 0; i < done.size(); ++i)
        if (done[i] == pauseAt) next.keep(film, layers, i, batches[batch].firstPixel + i);
    if (slowest < pauseAt || batch + 1 < batches.size()) return;
    next.samples = windowStart + pauseAt;
    std::swap(last, next);
    if (batches.size() > 1) return;
    const std::uint32_t fastest = *std::ranges::max_element(done);
    const double apart = std::clamp(std::max(kSnapshotMs, 0.05 * msSpent) / passMs(), 1.0, 1e9);
    const double at = std::max(fastest + 1.0, slowest + apart);
    pauseAt = at < windowSize ? static_cast<std::uint32_t>(at) : 0;
}

/// A render that is stopped has a second for its features: as many camera rays as fit, but one at least.
std::uint64_t Renderer::State::featureSamples() {
    constexpr double kSeconds = 1;
    if (!stopBy || settings.featureSamples < 2) return settings.featureSamples;
    const auto start = Clock::now();
    renderFeatures(device, scene, deviceScene, settings.seed, 1, constants);
    const double one = std::chrono::duration<double>(Clock::now() - start).count();
    return static_cast<std::uint64_t>(std::clamp(kSeconds / one, 1.0, double(settings.featureSamples)));
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
            .restart = restart,
            .pauseAt = pauseAt,
            .stallLimit = stuckAfter};
}

Renderer::Renderer(gpu::Device& device, const CompiledScene& scene, const RenderSettings& settings)
    : state_(std::make_unique<State>(device, scene, settings)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

bool Renderer::step() {
    State& s = *state_;
    if (s.isCutOff()) return false;
    if (s.windowSize == 0) {
        if (!s.hasMore()) return false;
        s.beginWindow();
        s.raiseLimit(0);
    }
    s.lastMs = s.pass.run(s.batch, s.arguments(s.batches[s.batch]));
    s.restart = false;
    s.msSpent += s.lastMs;
    s.checkCounters();
    const auto done = s.pass.samplesDone(s.batch);
    const std::uint32_t slowest = *std::ranges::min_element(done);
    s.takeSnapshot(done, slowest);
    if (slowest >= s.windowSize) {
        s.restart = true;
        if (++s.batch == s.batches.size()) {
            s.windowStart += s.windowSize;
            s.windowSize = 0;
            s.next = {};
        } else {
            s.limit = 0;
            s.raiseLimit(0);
        }
    } else {
        s.raiseLimit(slowest);
        s.adaptBudget();
    }
    return s.hasMore();
}

void Renderer::finishEarly(double seconds) {
    State& s = *state_;
    if (s.stopBy) return;
    s.stopBy = State::Clock::now() +
               std::chrono::duration_cast<State::Clock::duration>(std::chrono::duration<double>(seconds));
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
    for (std::size_t i = 0; i < s.batches.size(); ++i) {
        const auto pixels = s.pass.film(i);
        const auto layers = s.pass.layers(i);
        film.pixels.insert(film.pixels.end(), pixels.begin(), pixels.end());
        film.layers.insert(film.layers.end(), layers.begin(), layers.end());
    }
    film.depthLayers = s.scene.constants.depthLayers;
    film.counters = s.counters;
    return film;
}

Film Renderer::film() {
    State& s = *state_;
    Film film = filmSoFar();
    if (s.stopBy && s.windowSize != 0) {
        film.pixelSamples.clear();
        film.samples = s.last.samples;
        film.pixels = s.last.pixels;
        film.layers = s.last.layers;
        if (film.samples == 0) return film;
    }
    film.featureSamples = s.featureSamples();
    film.features = renderFeatures(s.device, s.scene, s.deviceScene, s.settings.seed, film.featureSamples, s.constants);
    return film;
}

Film render(gpu::Device& device, const CompiledScene& scene, const RenderSettings& settings) {
    Renderer renderer(device, scene, settings);
    while (renderer.step()) {
    }
    return renderer.film();
}

}  // namespace parhelion::render
