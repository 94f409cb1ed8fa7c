#pragma once

#include <array>

#include "base/film.h"
#include "compile/render_settings.h"
#include "gpu/pipeline.h"
#include "render/device_scene.h"

namespace parhelion::render {

/// Lanes driven together: whole bands of 8 pixel rows of the crop, and the control pixels in them, each in as many
/// lanes as it has runs.
struct Batch {
    std::uint32_t firstPixel = 0, pixelCount = 0;
    std::uint32_t firstControl = 0, controlCount = 0;

    std::uint32_t laneCount() const { return pixelCount + controlCount * shared::kControlRuns; }
};

/// A film of pixels, within batches of at most about `lanes` lanes; one band at least.
/// @param controlPixels  ascending.
std::vector<Batch> batchesOf(glm::uvec2 size, std::uint32_t lanes, std::span<const std::uint32_t> controlPixels);

/// The path tracing kernel with its film, saved paths and counters.
class PathTracePass {
public:
    /// A film of any size: each batch has a buffer of its own, within what the device can bind.
    PathTracePass(gpu::Device& device, const DeviceScene& deviceScene, const gpu::Specialisation& constants,
                  std::span<const Batch> batches, std::span<const std::uint32_t> controlPixels,
                  std::uint32_t depthLayers);

    /// Runs one dispatch over a batch. Returns device milliseconds; counters of the dispatch are in counters().
    double run(std::size_t batch, const shared::PathArguments& arguments);
    const std::array<std::uint64_t, shared::kCounterCount>& counters() const { return counters_; }
    /// Samples in each pixel of the batch that ran last, within its window, in the order of film().
    std::span<const std::uint32_t> samplesDone(std::size_t batch);
    /// A batch's pixels, in crop order, then the runs of its control pixels; and their layers by number of scatterings,
    /// if there are any.
    std::span<const shared::FilmPixel> film(std::size_t batch) { return films_[batch].as<shared::FilmPixel>(); }
    std::span<const shared::LayerPixel> layers(std::size_t batch);
    /// Largest loopBudget: loop-back tests of a subgroup, of the driver's 65535, that leave room for one more turn.
    static constexpr std::uint32_t kMaximumLoopBudget = 12000;

private:
    gpu::Device& device_;
    const DeviceScene& scene_;
    std::vector<Batch> batches_;
    std::uint32_t depthLayers_;
    std::vector<gpu::Buffer> films_;
    std::vector<gpu::Buffer> layers_;  // one that nothing uses, if there are no layers
    std::size_t bound_ = 0;            // batch whose film the pipeline points at
    gpu::Buffer paths_, counterBuffer_, argumentBuffer_;
    std::vector<gpu::Buffer> controls_;  // indices of each batch's control pixels
    gpu::ComputePipeline pipeline_;
    std::array<std::uint64_t, shared::kCounterCount> counters_{};

    void bindFilm(std::size_t batch);
};

/// The feature kernel: albedo, normal and depth of the first surfaces.
/// @param samples  camera rays a pixel.
/// @throws RuntimeFailure when a traversal was cut short.
std::vector<shared::FeaturePixel> renderFeatures(gpu::Device& device, const CompiledScene& scene,
                                                 const DeviceScene& deviceScene, std::uint32_t seed,
                                                 std::uint64_t samples, const gpu::Specialisation& constants);

}  // namespace parhelion::render
