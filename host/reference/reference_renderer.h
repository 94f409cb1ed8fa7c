#pragma once

#include <atomic>
#include <functional>

#include "base/film.h"
#include "compile/render_settings.h"
#include "reference/path_trace.h"

namespace parhelion::reference {

/// Renders on the CPU, in Real = float or double, over all cores. Follows shaders/README.md.
///
/// Reads from `scene.effects` nothing: every effect of the scene is always simulated.
/// @param stop      when it becomes true, the pass over the image in progress is finished, or left out where that takes
/// more than
///                  two seconds, and the rest left out (film.samples says how many were taken, perhaps none).
/// @param progress  called from the calling thread between passes with samples per pixel done so far.
template <typename Real>
Film render(const CompiledScene& scene, const RenderSettings& settings, const std::atomic<bool>* stop = nullptr,
            const std::function<void(std::uint64_t)>& progress = {});

extern template Film render<float>(const CompiledScene&, const RenderSettings&, const std::atomic<bool>*,
                                   const std::function<void(std::uint64_t)>&);
extern template Film render<double>(const CompiledScene&, const RenderSettings&, const std::atomic<bool>*,
                                    const std::function<void(std::uint64_t)>&);

/// One sample of one pixel, for parity tests.
///
/// @param trace  when given, receives the path's events and decisions.
template <typename Real>
glm::vec<3, Real> tracePath(const CompiledScene& scene, const RenderSettings& settings, glm::uvec2 pixel,
                            std::uint64_t sample, PathTrace* trace = nullptr);

extern template glm::vec3 tracePath<float>(const CompiledScene&, const RenderSettings&, glm::uvec2, std::uint64_t,
                                           PathTrace*);
extern template glm::dvec3 tracePath<double>(const CompiledScene&, const RenderSettings&, glm::uvec2, std::uint64_t,
                                             PathTrace*);

}  // namespace parhelion::reference
