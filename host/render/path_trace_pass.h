#pragma once

#include <array>

#include "base/film.h"
#include "compile/render_settings.h"
#include "gpu/pipeline.h"
#include "render/device_scene.h"

namespace parhelion::render {

/// A rectangle of lanes driven together: whole bands of 8 pixel rows of the crop.
struct Batch {
    std::uint32_t firstPixel = 0;
    std::uint32_t laneCount = 0;
};

/// The path tracing kernel with its film, saved paths and counters.
class PathTracePass {
public:
    /// A film of any size: each batch has a buffer of its own, within what the device can bind.
    PathTracePass(gpu::Device& device, const DeviceScene& deviceScene, const gpu::Specialisation& constants,
                  std::span<const Batch> batches, std::uint32_t depthLayers);

    /// Runs one dispatch over a batch. Returns device milliseconds; counters of the dispatch are in counters().
    double run(std::size_t batch, const shared::PathArguments& arguments);
    const std::array<std::uint64_t, shared::kCounterCount>& counters() const { return counters_; }
    /// Samples in each pixel of the batch that ran last, within its window, in crop order.
    std::span<const std::uint32_t> samplesDone(std::size_t batch);
    /// A batch's pixels, in crop order, and their layers by number of scatterings, if there are any.
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
