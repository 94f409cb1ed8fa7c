#include "render/path_trace_pass.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"

namespace parhelion::render {
namespace {

constexpr std::uint32_t kGroup = 64;              // local_size_x of the kernels
constexpr std::uint32_t kMaximumCrossings = 256;  // medium boundaries in front of the first opaque surface

std::uint32_t groupsCovering(std::uint32_t lanes) { return (lanes + kGroup - 1) / kGroup; }

std::vector<gpu::Binding> withBuffers(std::vector<gpu::Binding> bindings, std::initializer_list<gpu::Binding> more) {
    bindings.insert(bindings.end(), more);
    return bindings;
}

}  // namespace

PathTracePass::PathTracePass(gpu::Device& device, const CompiledScene& scene, const DeviceScene& deviceScene,
                             const gpu::Specialisation& constants, std::uint32_t maximumLanes)
    : device_(device),
      film_(device.createBuffer(std::size_t{scene.cropSize.x} * scene.cropSize.y * sizeof(shared::FilmPixel))),
      paths_(device.createBuffer(std::size_t{maximumLanes} * shared::kPathStateWords * 4)),
      counterBuffer_(device.createBuffer(shared::kCounterCount * 4)),
      pipeline_(device, gpu::shaderFolder() / "kernels/path_trace.comp", constants) {
    pipeline_.bind(withBuffers(deviceScene.bindings(), {{.index = 12, .buffer = film_.handle()},
                                                        {.index = 13, .buffer = paths_.handle()},
                                                        {.index = 14, .buffer = counterBuffer_.handle()}}));
}

double PathTracePass::run(const Batch& batch, const shared::PathArguments& arguments) {
    std::memset(counterBuffer_.data(), 0, counterBuffer_.size());
    const double ms = device_.submit([&](VkCommandBuffer commands) {
        pipeline_.record(commands, std::as_bytes(std::span(&arguments, 1)), groupsCovering(batch.laneCount));
    });
    std::ranges::copy(counterBuffer_.as<std::uint32_t>(), counters_.begin());
    return ms;
}

std::span<const std::uint32_t> PathTracePass::samplesDone(const Batch& batch) {
    return paths_.as<std::uint32_t>().subspan(std::size_t{shared::kPathSampleWord} * batch.laneCount, batch.laneCount);
}

std::vector<shared::FeaturePixel> renderFeatures(gpu::Device& device, const CompiledScene& scene,
                                                 const DeviceScene& deviceScene, const RenderSettings& settings,
                                                 const gpu::Specialisation& constants) {
    const std::uint32_t pixels = scene.cropSize.x * scene.cropSize.y;
    gpu::Buffer features = device.createBuffer(std::size_t{pixels} * sizeof(shared::FeaturePixel));
    gpu::Buffer counters = device.createBuffer(shared::kCounterCount * 4);
    gpu::ComputePipeline pipeline(device, gpu::shaderFolder() / "kernels/features.comp", constants);
    pipeline.bind(withBuffers(deviceScene.bindings(), {{.index = 14, .buffer = counters.handle()},
                                                       {.index = 15, .buffer = features.handle()}}));
    constexpr std::uint32_t kLanes = 1u << 18;
    for (std::uint32_t sample = 0; sample < settings.featureSamples; ++sample)
        for (std::uint32_t first = 0; first < pixels; first += kLanes) {
            const shared::PathArguments arguments{.filmSize = scene.filmSize,
                                                  .cropOffset = scene.cropOffset,
                                                  .cropSize = scene.cropSize,
                                                  .firstPixel = first,
                                                  .laneCount = std::min(kLanes, pixels - first),
                                                  .sampleLow = sample,
                                                  .sampleHigh = 0,
                                                  .sampleCount = 1,
                                                  .seed = settings.seed,
                                                  .loopBudget = kMaximumCrossings,
                                                  .restart = 0};
            device.submit([&](VkCommandBuffer commands) {
                pipeline.record(commands, std::as_bytes(std::span(&arguments, 1)), groupsCovering(arguments.laneCount));
            });
        }
    if (counters.as<std::uint32_t>()[shared::kCounterBvhOverflow] != 0)
        throw RuntimeFailure("the feature pass was cut short: a ray crossed too many boundaries or BVH nodes");
    const auto all = features.as<shared::FeaturePixel>();
    return {all.begin(), all.end()};
}

}  // namespace parhelion::render
