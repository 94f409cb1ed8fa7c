#pragma once

#include <chrono>
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
    double dispatchMs = 0;        ///< device time of the last dispatch
    double passMs = 0;            ///< device time for a sample of every pixel
    std::uint64_t snapshots = 0;  ///< how many moments there have been when all pixels had the same samples
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
    /// Ends at `deadline` instead of at the settings' samples, if that comes first: all pixels with equally many, or,
    /// on a film too large to be rendered at once, its upper part with some more. The features are rendered now.
    void setDeadline(std::chrono::steady_clock::time_point deadline);
    /// Changes how many samples a pixel gets, but not below what is begun. Returns how many those are.
    /// A choice that depends on the image's own samples would bias it; one that depends on the control pixels does not.
    std::uint64_t setSampleCount(std::uint64_t count);
    Progress progress() const;
    /// The film so far, without features: within a window with the samples of each pixel, and `samples` those all
    /// pixels have.
    Film filmSoFar();
    /// The film as it was when all pixels last had equally many samples, perhaps none; without features.
    Film snapshot() const;
    /// The film with features, which are rendered for it; after finishEarly() with as many of them as a second allows.
    Film film();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Renders everything: step() until done.
Film render(gpu::Device& device, const CompiledScene& scene, const RenderSettings& settings);

}  // namespace parhelion::render
