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
    PathTracePass(gpu::Device& device, const CompiledScene& scene, const DeviceScene& deviceScene,
                  const gpu::Specialisation& constants, std::uint32_t maximumLanes);

    /// Runs one dispatch over `batch`. Returns device milliseconds; counters of the dispatch are in counters().
    double run(const Batch& batch, const shared::PathArguments& arguments);
    const std::array<std::uint32_t, shared::kCounterCount>& counters() const { return counters_; }
    /// Samples finished by each lane of the batch that ran last, within its window.
    std::span<const std::uint32_t> samplesDone(const Batch& batch);
    std::span<const shared::FilmPixel> film() { return film_.as<shared::FilmPixel>(); }
    /// Words the loop of one turn may spend beyond its budget: what loopBudget must leave of the driver's 65535.
    static constexpr std::uint32_t kMaximumLoopBudget = 12000;

private:
    gpu::Device& device_;
    gpu::Buffer film_, paths_, counterBuffer_;
    gpu::ComputePipeline pipeline_;
    std::array<std::uint32_t, shared::kCounterCount> counters_{};
};

/// The feature kernel: albedo, normal and depth of the first surfaces.
/// @throws RuntimeFailure when a traversal was cut short.
std::vector<shared::FeaturePixel> renderFeatures(gpu::Device& device, const CompiledScene& scene,
                                                 const DeviceScene& deviceScene, const RenderSettings& settings,
                                                 const gpu::Specialisation& constants);

}  // namespace parhelion::render
