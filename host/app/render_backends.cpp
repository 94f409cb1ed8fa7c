#include "app/render_backends.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "app/text_format.h"
#include "reference/reference_renderer.h"
#include "render/renderer.h"

namespace parhelion::app {

namespace {

double pixelCount(const CompiledScene& scene) { return static_cast<double>(scene.cropSize.x) * scene.cropSize.y; }

/// From here on there is an image to save.
void beginRendering(const CompiledScene& scene, const RenderSettings& settings, const std::string& device,
                    Interruption& interruption, ProgressDisplay& progress) {
    interruption.deferFirst();
    progress.begin(fmt::format("rendering {}, {} samples per pixel, on {}", formatSize(scene.cropSize),
                               settings.sampleCount, device),
                   pixelCount(scene) * static_cast<double>(settings.sampleCount));
}

}  // namespace

RenderOutcome renderWithVulkan(gpu::Device& device, const CompiledScene& scene, const RenderSettings& settings,
                               Interruption& interruption, ProgressDisplay& progress) {
    const auto start = std::chrono::steady_clock::now();
    render::Renderer renderer(device, scene, settings);
    RenderOutcome outcome;
    outcome.device = device.info().name;
    outcome.driver = device.info().driver;
    outcome.prepareSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    beginRendering(scene, settings, outcome.device, interruption, progress);
    while (renderer.step()) {
        if (interruption.requested()) renderer.finishEarly();
        progress.update(renderer.progress().samplesDone, [&] { return renderer.filmSoFar(); });
    }
    outcome.seconds = progress.secondsSinceBegin();
    progress.end();
    outcome.film = renderer.film();
    return outcome;
}

template <typename Real>
RenderOutcome renderWithReference(const CompiledScene& scene, const RenderSettings& settings,
                                  Interruption& interruption, ProgressDisplay& progress) {
    RenderOutcome outcome;
    outcome.device = fmt::format("CPU, {} threads", std::thread::hardware_concurrency());
    outcome.driver = sizeof(Real) == sizeof(double) ? "reference in double" : "reference in float";
    beginRendering(scene, settings, outcome.device, interruption, progress);
    outcome.film = reference::render<Real>(scene, settings, &interruption.requested(), [&](std::uint64_t samples) {
        progress.update(static_cast<double>(samples) * pixelCount(scene));
    });
    outcome.seconds = progress.secondsSinceBegin();
    progress.end();
    return outcome;
}

template RenderOutcome renderWithReference<float>(const CompiledScene&, const RenderSettings&, Interruption&,
                                                  ProgressDisplay&);
template RenderOutcome renderWithReference<double>(const CompiledScene&, const RenderSettings&, Interruption&,
                                                   ProgressDisplay&);

}  // namespace parhelion::app
