#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "analysis/error_monitor.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include "base/film.h"
#include "compile/render_settings.h"
#include "gpu/device.h"

namespace parhelion::app {

/// What may end a render besides the samples of its settings.
struct RenderTargets {
    std::optional<double> error;  ///< share of 1, by the norm
    ErrorNorm norm = ErrorNorm::Rms;
    std::optional<std::chrono::steady_clock::time_point> deadline;  ///< for rendering
};

enum class EndedBy { Samples, Error, Time, Interruption, NotYet };
const char* nameOf(EndedBy reason);

/// What a back end has made of a scene, whole or interrupted.
struct RenderOutcome {
    Film film;
    std::string device, driver;
    double prepareSeconds = 0;
    double seconds = 0;
    EndedBy endedBy = EndedBy::Samples;
    std::vector<ErrorCheckpoint> checkpoints;
    std::optional<double> controlError;      ///< by the norm, from the control pixels: what the targets go by
    std::optional<double> samplesForTarget;  ///< a pixel, and the time for it: as predicted in the end
    std::optional<double> secondsForTarget;
    std::optional<double> samplesForHalf, secondsForHalf;  ///< the same for half of the error
};

/// What is written of a render on its way.
struct IntermediateFiles {
    double seconds = 0;                                              ///< from one to the next
    std::function<std::string(const RenderOutcome& outcome)> write;  ///< returns the picture's name; none: nothing
};

/// Renders on a Vulkan device until a target is reached, all samples are done, or interrupted. Interruptions before the
/// first sample end the process.
/// @throws RuntimeFailure for a failing device.
RenderOutcome renderWithVulkan(gpu::Device& device, const CompiledScene& scene, const RenderSettings& settings,
                               const RenderTargets& targets, const IntermediateFiles& intermediate,
                               Interruption& interruption, ProgressDisplay& progress);

/// Renders with the CPU reference in Real = float or double.
template <typename Real>
RenderOutcome renderWithReference(const CompiledScene& scene, const RenderSettings& settings,
                                  Interruption& interruption, ProgressDisplay& progress);

extern template RenderOutcome renderWithReference<float>(const CompiledScene&, const RenderSettings&, Interruption&,
                                                         ProgressDisplay&);
extern template RenderOutcome renderWithReference<double>(const CompiledScene&, const RenderSettings&, Interruption&,
                                                          ProgressDisplay&);

}  // namespace parhelion::app
