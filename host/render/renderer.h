#pragma once

#include <functional>
#include <memory>

#include "base/film.h"
#include "compile/render_settings.h"
#include "gpu/device.h"

namespace parhelion::render {

/// How far a render has come.
struct Progress {
    double samplesDone = 0;  ///< over all pixels
    double samplesTotal = 0;
    double dispatchMs = 0;  ///< device time of the last dispatch
};

/// Renders a CompiledScene on a Vulkan device, a dispatch at a time.
///
/// A window of samples is started for every pixel and driven to its end by as many dispatches as
/// it takes; each dispatch is sized from the time of the ones before it. The film does not depend on the sizing.
class Renderer {
public:
    /// Uploads the scene and builds the pipelines. `shaderFolder` holds `kernels/`.
    Renderer(gpu::Device& device, const CompiledScene& scene, const RenderSettings& settings);
    ~Renderer();
    Renderer(Renderer&&) noexcept;

    /// Runs one dispatch. Returns false when every sample is done.
    /// @throws RuntimeFailure when the device cut a loop or a traversal short, or a path makes no progress.
    bool step();
    /// No further samples are begun but for pixels that are behind: step() returns false once all have equally many, or
    /// after `seconds`, at the end of a dispatch. The film is then as it was when all last had: perhaps without
    /// samples.
    void finishEarly(double seconds = 2);
    Progress progress() const;
    /// The film so far, without features: within a window with the samples of each pixel, and `samples` those all
    /// pixels have.
    Film filmSoFar();
    /// The film with features, which are rendered for it; after finishEarly() with as many of them as a second allows.
    Film film();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Renders everything: step() until done.
Film render(gpu::Device& device, const CompiledScene& scene, const RenderSettings& settings);

}  // namespace parhelion::render
