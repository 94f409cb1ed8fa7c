#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "render/path_trace_pass.h"
#include "render/sample_schedule.h"
#include "render/snapshot.h"
#include "render/specialise.h"

namespace parhelion::render {
namespace {

constexpr double kTargetMs = 150;  // a dispatch: short enough for progress and Ctrl-C
constexpr std::uint32_t kMinimumBudget = 6000;

/// Lanes driven together. On a CPU the saved paths should stay near the caches; a GPU wants many.
std::uint32_t maximumLanes(const gpu::Device& device) { return device.info().software ? 1u << 17 : 1u << 20; }

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
          batches(batchesOf(scene_.cropSize, maximumLanes(device_), settings_.controls.pixels)),
          pass(device_, deviceScene, constants, batches, settings_.controls.pixels, scene_.constants.depthLayers),
          schedule(batches.size(), double(scene_.cropSize.x) * scene_.cropSize.y, settings_.sampleCount),
          stuckAfter(stallLimit(scene_)) {}

    gpu::Device& device;
    const CompiledScene& scene;
    RenderSettings settings;
    gpu::Specialisation constants;
    DeviceScene deviceScene;
    std::vector<Batch> batches;
    PathTracePass pass;
    SampleSchedule schedule;

    std::array<std::uint64_t, shared::kCounterCount> counters{};
    Snapshot last, next;  // the last moment when all pixels had the same samples, and the one under way
    std::uint64_t snapshots = 0;
    std::optional<Clock::time_point> stopBy;  // when a render that is to finish early is cut off
    std::optional<Clock::time_point> deadline;
    std::uint32_t stuckAfter;  // turns
    std::uint32_t loopBudget = 512;
    double lastMs = 0;
    std::vector<shared::FeaturePixel> features;
    std::uint64_t featureSamples = 0;  // in `features`; 0: not rendered yet

    std::optional<double> secondsLeft() const;
    void checkCounters();
    void adaptBudget();
    void takeSnapshot(std::span<const std::uint32_t> done, SampleSchedule::Reached reached);
    bool isCutOff() const { return stopBy && Clock::now() >= *stopBy; }
    void ensureFeatures();
    void closeWindow();
    std::vector<std::uint64_t> samplesByPixel();
    Snapshot filmsNow();
    void describe(Film& film) const;
    shared::PathArguments arguments(const Batch& running) const;
    double pathsDone() const { return static_cast<double>(counters[shared::kCounterPathsFinished]); }
};

std::optional<double> Renderer::State::secondsLeft() const {
    return deadline ? std::optional(std::chrono::duration<double>(*deadline - Clock::now()).count()) : std::nullopt;
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
            "turns at one point of a ray, in boundaries or collisions that never end. Nothing was written. This is a "
            "fault of the renderer, or of distances and densities that 32-bit floats cannot tell apart; please report "
            "it with the scene",
            now[shared::kCounterStuck],
            settings.firstSample + schedule.windowStart() + now[shared::kCounterStuckSample],
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
void Renderer::State::takeSnapshot(std::span<const std::uint32_t> done, SampleSchedule::Reached reached) {
    const std::size_t batch = schedule.batch();
    const std::uint32_t pauseAt = schedule.pauseAt();
    if (pauseAt == 0) return;
    const auto film = pass.film(batch);
    const auto layers = pass.layers(batch);
    for (std::size_t i = 0; i < done.size(); ++i)
        if (done[i] == pauseAt) next.keep(batches[batch], film, layers, i);
    if (reached.slowest < pauseAt || batch + 1 < batches.size()) return;
    next.samples = schedule.windowStart() + pauseAt;
    std::swap(last, next);
    ++snapshots;
    if (batches.size() == 1) schedule.pauseAgain(reached);
}

/// All pixels have the same samples now.
void Renderer::State::closeWindow() {
    next = {};
    if (last.samples == schedule.windowStart()) return;
    last = filmsNow();
    last.samples = schedule.windowStart();
    ++snapshots;
}

/// A render that is stopped has a second for its features: as many camera rays as fit, but one at least.
void Renderer::State::ensureFeatures() {
    constexpr double kSeconds = 1;
    if (featureSamples >= settings.featureSamples) return;
    featureSamples = settings.featureSamples;
    if (stopBy && featureSamples > 1) {
        const auto start = Clock::now();
        renderFeatures(device, scene, deviceScene, settings.seed, 1, constants);
        const double one = std::chrono::duration<double>(Clock::now() - start).count();
        featureSamples = static_cast<std::uint64_t>(std::clamp(kSeconds / one, 1.0, double(featureSamples)));
    }
    features = renderFeatures(device, scene, deviceScene, settings.seed, featureSamples, constants);
}

/// Within a window batches, and the pixels of a batch, differ.
std::vector<std::uint64_t> Renderer::State::samplesByPixel() {
    std::vector<std::uint64_t> samples;
    const std::uint64_t start = schedule.windowStart();
    for (std::size_t i = 0; i < batches.size(); ++i) {
        const std::uint32_t pixels = batches[i].pixelCount;
        samples.insert(samples.end(), pixels, start + (i < schedule.batch() ? schedule.windowSize() : 0));
        if (i != schedule.batch() || schedule.restarts()) continue;
        const auto done = pass.samplesDone(i).first(pixels);
        std::ranges::transform(done, samples.end() - pixels, [&](auto n) { return start + n; });
    }
    return samples;
}

/// What the films hold now.
Snapshot Renderer::State::filmsNow() {
    Snapshot now;
    for (std::size_t i = 0; i < batches.size(); ++i)
        for (std::size_t lane = 0; lane < batches[i].laneCount(); ++lane)
            now.keep(batches[i], pass.film(i), pass.layers(i), lane);
    return now;
}

/// What does not change while the film does.
void Renderer::State::describe(Film& film) const {
    film.filmSize = scene.filmSize;
    film.crop = {scene.cropOffset, scene.cropSize};
    film.radianceUnit = scene.radianceUnit;
    film.stratified = settings.quality.sobol;
    film.depthLayers = scene.constants.depthLayers;
    film.controlTileEdge = settings.controls.tileEdge;
    for (const std::uint32_t pixel : settings.controls.pixels) film.controls.push_back({.pixel = pixel});
    film.counters = counters;
}

shared::PathArguments Renderer::State::arguments(const Batch& running) const {
    const std::uint64_t first = settings.firstSample + schedule.windowStart();
    return {.filmSize = scene.filmSize,
            .cropOffset = scene.cropOffset,
            .cropSize = scene.cropSize,
            .firstPixel = running.firstPixel,
            .laneCount = running.laneCount(),
            .sampleLow = static_cast<std::uint32_t>(first),
            .sampleHigh = static_cast<std::uint32_t>(first >> 32),
            .sampleCount = schedule.limit(),
            .seed = settings.seed,
            .loopBudget = loopBudget,
            .restart = schedule.restarts(),
            .pauseAt = schedule.pauseAt(),
            .stallLimit = stuckAfter,
            .imageLanes = running.pixelCount,
            .emptyFilm = schedule.windowStart() == 0};
}

Renderer::Renderer(gpu::Device& device, const CompiledScene& scene, const RenderSettings& settings)
    : state_(std::make_unique<State>(device, scene, settings)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

bool Renderer::step() {
    State& s = *state_;
    if (s.isCutOff() || !s.schedule.begin(s.secondsLeft())) return false;
    const std::size_t batch = s.schedule.batch();
    s.lastMs = s.pass.run(batch, s.arguments(s.batches[batch]));
    s.checkCounters();
    const auto done = s.pass.samplesDone(batch);
    const SampleSchedule::Reached reached{std::ranges::min(done), std::ranges::max(done)};
    const bool isComplete = s.schedule.advance(reached, s.lastMs, s.pathsDone(), s.secondsLeft());
    s.takeSnapshot(done, reached);
    if (!isComplete) {
        s.adaptBudget();
        return true;
    }
    s.schedule.next(s.secondsLeft());
    if (s.schedule.windowSize() == 0) s.closeWindow();
    return s.schedule.begin(s.secondsLeft());
}

void Renderer::finishEarly(double seconds) {
    State& s = *state_;
    if (s.stopBy) return;
    s.stopBy = State::Clock::now() +
               std::chrono::duration_cast<State::Clock::duration>(std::chrono::duration<double>(seconds));
    s.schedule.finish();
}

void Renderer::setDeadline(std::chrono::steady_clock::time_point deadline) {
    state_->ensureFeatures();
    state_->deadline = deadline;
}

std::uint64_t Renderer::setSampleCount(std::uint64_t count) {
    return state_->stopBy ? state_->schedule.sampleCount() : state_->schedule.setSampleCount(count);
}

Progress Renderer::progress() const {
    const State& s = *state_;
    const double pixels = static_cast<double>(s.scene.cropSize.x) * s.scene.cropSize.y;
    return {.samplesDone = s.pathsDone(),
            .samplesTotal = pixels * static_cast<double>(s.schedule.sampleCount()),
            .dispatchMs = s.lastMs,
            .passMs = s.schedule.passMs(),
            .snapshots = s.snapshots};
}

Film Renderer::filmSoFar() {
    Film film;
    State& s = *state_;
    s.describe(film);
    film.samples = s.schedule.windowStart();
    if (s.schedule.windowSize() != 0) film.pixelSamples = s.samplesByPixel();
    s.filmsNow().moveTo(film);
    return film;
}

Film Renderer::snapshot() const {
    Film film;
    state_->describe(film);
    film.samples = state_->last.samples;
    Snapshot(state_->last).moveTo(film);
    return film;
}

Film Renderer::film() {
    State& s = *state_;
    const bool isWhole = s.schedule.windowSize() == 0 || s.schedule.endsWithin();
    Film film = s.stopBy && !isWhole ? snapshot() : filmSoFar();
    if (!s.stopBy || film.samples > 0) s.ensureFeatures();
    film.featureSamples = s.featureSamples;
    film.features = s.features;
    return film;
}

Film render(gpu::Device& device, const CompiledScene& scene, const RenderSettings& settings) {
    Renderer renderer(device, scene, settings);
    while (renderer.step()) {
    }
    return renderer.film();
}

}  // namespace parhelion::render
