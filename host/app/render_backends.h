#pragma once

#include <string>

#include "app/interrupt.h"
#include "app/progress.h"
#include "base/film.h"
#include "compile/render_settings.h"
#include "gpu/device.h"

namespace parhelion::app {

/// What a back end has made of a scene, whole or interrupted.
struct RenderOutcome {
    Film film;
    std::string device, driver;
    double prepareSeconds = 0;
    double seconds = 0;
};

/// Renders on a Vulkan device until done or interrupted. Interruptions before the first sample end the process.
/// @throws RuntimeFailure for a failing device.
RenderOutcome renderWithVulkan(gpu::Device& device, const CompiledScene& scene, const RenderSettings& settings,
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
