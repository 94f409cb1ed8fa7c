#include "app/render_backends.h"

#include <fmt/format.h>

#include <thread>

#include "analysis/stopping_rule.h"
#include "app/text_format.h"
#include "reference/reference_renderer.h"
#include "render/renderer.h"

namespace parhelion::app {

namespace {

double pixelCount(const CompiledScene& scene) { return static_cast<double>(scene.cropSize.x) * scene.cropSize.y; }

std::string describeTargets(const RenderSettings& settings, const RenderTargets& targets) {
    std::string text;
    if (targets.error)
        text += fmt::format("until the error ({}) is {}, ", nameOf(targets.norm), formatPercent(*targets.error));
    if (targets.deadline)
        text += fmt::format(
            "for {}, ",
            formatDuration(
                std::chrono::duration<double>(*targets.deadline - std::chrono::steady_clock::now()).count()));
    const bool isLimited = targets.error || targets.deadline;
    if (isLimited && settings.sampleCount >= kUnlimitedSamples) return text;
    return text + fmt::format("{}{} samples per pixel, ", isLimited ? "at most " : "", settings.sampleCount);
}

/// From here on there is an image to save.
void beginRendering(const CompiledScene& scene, const RenderSettings& settings, const RenderTargets& targets,
                    const std::string& device, Interruption& interruption, ProgressDisplay& progress) {
    interruption.deferFirst();
    progress.begin(
        fmt::format("rendering {}, {}on {}", formatSize(scene.cropSize), describeTargets(settings, targets), device),
        pixelCount(scene), settings.sampleCount, targets.error, targets.deadline);
}

/// A render under way with what is known of its error.
struct Run {
    render::Renderer& renderer;
    ErrorMonitor monitor;
    Interruption& interruption;
    ProgressDisplay& progress;
    bool hasControls;
    const IntermediateFiles& intermediate;
    RenderOutcome& outcome;
    std::uint64_t snapshots = 0;
    std::optional<std::chrono::steady_clock::time_point> deadline;
    double nextSave = 0, writeSeconds = 0;

    void look(const Film& film) {
        if (!hasControls || !film.pixelSamples.empty()) return;
        monitor.add(film, progress.secondsSinceBegin());
    }

    /// Of a moment at which all pixels have equally many samples.
    void take(const Film& film) {
        look(film);
        const double begun = progress.secondsSinceBegin();
        if (!intermediate.write || begun < nextSave) return;
        if (deadline &&
            std::chrono::duration<double>(*deadline - std::chrono::steady_clock::now()).count() < 3 * writeSeconds)
            return;
        outcome.film = film;
        outcome.seconds = begun;
        const std::string picture = intermediate.write(outcome);
        if (nextSave == 0) progress.note(fmt::format("a first picture after {}: {}", formatDuration(begun), picture));
        // Writing takes no more than a twentieth of the time.
        const double after = progress.secondsSinceBegin();
        writeSeconds = after - begun;
        nextSave = after + std::max(intermediate.seconds, 20 * (after - begun));
    }

    /// Until all samples that were asked for are done, or the time is over.
    void advance() {
        while (renderer.step()) {
            if (interruption.requested()) renderer.finishEarly();
            const render::Progress now = renderer.progress();
            if (now.snapshots > snapshots) take(renderer.snapshot());
            snapshots = now.snapshots;
            progress.update(now.samplesDone, now.samplesTotal, monitor);
        }
    }
};

constexpr std::uint64_t kPilot = 16, kLongPilot = 64;  // samples after which there is a prediction

/// Says what the target will cost.
void predict(Run& run, double error) {
    const auto samples = run.monitor.samplesFor(error);
    if (!samples || run.monitor.checkpoints().back().error <= error) return;
    const ErrorCheckpoint& now = run.monitor.checkpoints().back();
    run.progress.note(fmt::format("after {} samples the error is {}; {} will take about {:.0f} samples per pixel, {}",
                                  now.samples, formatPercent(now.error), formatPercent(error), *samples,
                                  formatDuration(run.monitor.secondsAt(*samples).value_or(0))));
}

EndedBy renderToError(Run& run, double error, std::uint64_t maximum) {
    std::uint64_t nextPrediction = kPilot;
    const auto renderTo = [&](std::uint64_t samples) {
        const auto& points = run.monitor.checkpoints();
        const std::uint64_t now = points.empty() ? 0 : points.back().samples;
        if (now >= nextPrediction) {
            predict(run, error);
            nextPrediction = now < kLongPilot ? kLongPilot : kUnlimitedSamples;
        }
        run.renderer.setSampleCount(samples);
        run.advance();
        return run.renderer.filmSoFar();
    };
    const RuleEnd end =
        follow(StoppingRule(error, maximum), run.monitor, renderTo, [&] { return run.progress.secondsSinceBegin(); });
    if (end == RuleEnd::Reached) return EndedBy::Error;
    if (run.interruption.requested()) return EndedBy::Interruption;
    return end == RuleEnd::Maximum ? EndedBy::Samples : EndedBy::Time;
}

}  // namespace

const char* nameOf(EndedBy reason) {
    switch (reason) {
        case EndedBy::Samples:
            return "samples";
        case EndedBy::Error:
            return "error";
        case EndedBy::Time:
            return "time";
        case EndedBy::Interruption:
            return "interruption";
        case EndedBy::NotYet:
            return "not yet";
    }
    return "";
}

RenderOutcome renderWithVulkan(gpu::Device& device, const CompiledScene& scene, const RenderSettings& settings,
                               const RenderTargets& targets, const IntermediateFiles& intermediate,
                               Interruption& interruption, ProgressDisplay& progress) {
    const auto start = std::chrono::steady_clock::now();
    render::Renderer renderer(device, scene, settings);
    if (targets.deadline) renderer.setDeadline(*targets.deadline);
    RenderOutcome outcome;
    outcome.device = device.info().name;
    outcome.driver = device.info().driver;
    outcome.prepareSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    beginRendering(scene, settings, targets, outcome.device, interruption, progress);
    Run run{renderer, ErrorMonitor(targets.norm),        interruption,
            progress, !settings.controls.pixels.empty(), intermediate,
            outcome};
    run.deadline = targets.deadline;
    outcome.endedBy = EndedBy::NotYet;
    if (targets.error) {
        outcome.endedBy = renderToError(run, *targets.error, settings.sampleCount);
    } else {
        run.advance();
        const bool isDone = renderer.progress().samplesDone >= renderer.progress().samplesTotal;
        outcome.endedBy = interruption.requested() ? EndedBy::Interruption : isDone ? EndedBy::Samples : EndedBy::Time;
    }
    outcome.seconds = progress.secondsSinceBegin();
    progress.end();
    outcome.film = renderer.film();
    run.look(outcome.film);
    outcome.checkpoints = run.monitor.checkpoints();
    if (!outcome.checkpoints.empty()) outcome.controlError = outcome.checkpoints.back().error;
    if (targets.error) outcome.samplesForTarget = run.monitor.samplesFor(*targets.error);
    if (outcome.samplesForTarget) outcome.secondsForTarget = run.monitor.secondsAt(*outcome.samplesForTarget);
    if (outcome.controlError) outcome.samplesForHalf = run.monitor.samplesFor(*outcome.controlError / 2);
    if (outcome.samplesForHalf) outcome.secondsForHalf = run.monitor.secondsAt(*outcome.samplesForHalf);
    return outcome;
}

template <typename Real>
RenderOutcome renderWithReference(const CompiledScene& scene, const RenderSettings& settings,
                                  Interruption& interruption, ProgressDisplay& progress) {
    RenderOutcome outcome;
    outcome.device = fmt::format("CPU, {} threads", std::thread::hardware_concurrency());
    outcome.driver = sizeof(Real) == sizeof(double) ? "reference in double" : "reference in float";
    beginRendering(scene, settings, {}, outcome.device, interruption, progress);
    const ErrorMonitor unknown(ErrorNorm::Rms);
    const double total = pixelCount(scene) * static_cast<double>(settings.sampleCount);
    outcome.film = reference::render<Real>(scene, settings, &interruption.requested(), [&](std::uint64_t samples) {
        progress.update(static_cast<double>(samples) * pixelCount(scene), total, unknown);
    });
    outcome.seconds = progress.secondsSinceBegin();
    if (interruption.requested()) outcome.endedBy = EndedBy::Interruption;
    progress.end();
    return outcome;
}

template RenderOutcome renderWithReference<float>(const CompiledScene&, const RenderSettings&, Interruption&,
                                                  ProgressDisplay&);
template RenderOutcome renderWithReference<double>(const CompiledScene&, const RenderSettings&, Interruption&,
                                                   ProgressDisplay&);

}  // namespace parhelion::app
