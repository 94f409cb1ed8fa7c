#include "render/path_trace_pass.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"

namespace parhelion::render {
namespace {

constexpr std::uint32_t kGroup = 64;  // local_size_x of the kernels
constexpr std::uint32_t kFeatureLanes = 1u << 18;
constexpr std::size_t kCounterBytes = shared::kCounterCount * sizeof(std::uint64_t);
constexpr std::uint32_t kMaximumCrossings = 8192;  // medium boundaries in front of the first opaque surface

std::uint32_t groupsCovering(std::uint32_t lanes) { return (lanes + kGroup - 1) / kGroup; }

std::size_t mostLanes(std::span<const Batch> batches) {
    std::size_t most = 0;
    for (const Batch& batch : batches) most = std::max<std::size_t>(most, batch.laneCount());
    return most;
}

std::vector<gpu::Binding> withBuffers(std::vector<gpu::Binding> bindings, std::initializer_list<gpu::Binding> more) {
    bindings.insert(bindings.end(), more);
    return bindings;
}

}  // namespace

std::vector<Batch> batchesOf(glm::uvec2 size, std::uint32_t lanes, std::span<const std::uint32_t> controlPixels) {
    const std::uint32_t band = 8 * size.x, pixels = size.x * size.y;
    const std::uint32_t step = std::max(1u, lanes / band) * band;
    std::vector<Batch> batches;
    std::uint32_t control = 0;
    for (std::uint32_t first = 0; first < pixels; first += step) {
        Batch batch{first, std::min(step, pixels - first), control, 0};
        while (control < controlPixels.size() && controlPixels[control] < first + batch.pixelCount) ++control;
        batch.controlCount = control - batch.firstControl;
        batches.push_back(batch);
    }
    return batches;
}

PathTracePass::PathTracePass(gpu::Device& device, const DeviceScene& deviceScene, const gpu::Specialisation& constants,
                             std::span<const Batch> batches, std::span<const std::uint32_t> controlPixels,
                             std::uint32_t depthLayers)
    : device_(device),
      scene_(deviceScene),
      batches_(batches.begin(), batches.end()),
      depthLayers_(depthLayers),
      paths_(device.createBuffer(mostLanes(batches) * shared::kPathStateWords * 4)),
      counterBuffer_(device.createBuffer(kCounterBytes)),
      argumentBuffer_(device.createBuffer(sizeof(shared::PathArguments))),
      pipeline_(device, gpu::shaderFolder() / "kernels/path_trace.comp", constants) {
    for (const Batch& batch : batches_) {
        films_.push_back(device.createBuffer(std::size_t{batch.laneCount()} * sizeof(shared::FilmPixel)));
        controls_.push_back(device.createBuffer(batch.controlCount * sizeof(std::uint32_t)));
        controls_.back().write(0, std::as_bytes(controlPixels.subspan(batch.firstControl, batch.controlCount)));
    }
    if (depthLayers == 0) layers_.push_back(device.createBuffer(sizeof(shared::LayerPixel)));
    for (std::size_t i = 0; depthLayers > 0 && i < batches_.size(); ++i)
        layers_.push_back(
            device.createBuffer(std::size_t{batches_[i].laneCount()} * depthLayers * sizeof(shared::LayerPixel)));
    bindFilm(0);
}

void PathTracePass::bindFilm(std::size_t batch) {
    const std::size_t layer = depthLayers_ == 0 ? 0 : batch;
    pipeline_.bind(withBuffers(scene_.bindings(), {{.index = 12, .buffer = films_[batch].handle()},
                                                   {.index = 13, .buffer = paths_.handle()},
                                                   {.index = 14, .buffer = counterBuffer_.handle()},
                                                   {.index = 26, .buffer = layers_[layer].handle()},
                                                   {.index = 28, .buffer = argumentBuffer_.handle()},
                                                   {.index = 29, .buffer = controls_[batch].handle()}}));
    bound_ = batch;
}

double PathTracePass::run(std::size_t batch, const shared::PathArguments& arguments) {
    if (batch != bound_) bindFilm(batch);
    std::memset(counterBuffer_.data(), 0, counterBuffer_.size());
    argumentBuffer_.write(0, std::as_bytes(std::span(&arguments, 1)));
    const double ms = device_.submit(
        [&](VkCommandBuffer commands) { pipeline_.record(commands, {}, groupsCovering(arguments.laneCount)); });
    const auto words = counterBuffer_.as<std::uint32_t>();
    for (std::size_t i = 0; i < counters_.size(); ++i)
        counters_[i] = words[i] | std::uint64_t{words[counters_.size() + i]} << 32;
    return ms;
}

std::span<const std::uint32_t> PathTracePass::samplesDone(std::size_t batch) {
    const std::uint32_t lanes = batches_[batch].laneCount();
    return paths_.as<std::uint32_t>().subspan(std::size_t{shared::kPathSampleWord} * lanes, lanes);
}

std::span<const shared::LayerPixel> PathTracePass::layers(std::size_t batch) {
    if (depthLayers_ == 0) return {};
    return layers_[batch].as<shared::LayerPixel>();
}

std::vector<shared::FeaturePixel> renderFeatures(gpu::Device& device, const CompiledScene& scene,
                                                 const DeviceScene& deviceScene, std::uint32_t seed,
                                                 std::uint64_t samples, const gpu::Specialisation& constants) {
    const std::uint32_t pixels = scene.cropSize.x * scene.cropSize.y;
    gpu::Buffer counters = device.createBuffer(kCounterBytes);
    gpu::Buffer argumentBuffer = device.createBuffer(sizeof(shared::PathArguments));
    gpu::ComputePipeline pipeline(device, gpu::shaderFolder() / "kernels/features.comp", constants);
    std::vector<shared::FeaturePixel> all;
    for (std::uint32_t first = 0; first < pixels; first += kFeatureLanes) {
        const std::uint32_t lanes = std::min(kFeatureLanes, pixels - first);
        gpu::Buffer features = device.createBuffer(std::size_t{lanes} * sizeof(shared::FeaturePixel));
        pipeline.bind(withBuffers(deviceScene.bindings(), {{.index = 14, .buffer = counters.handle()},
                                                           {.index = 15, .buffer = features.handle()},
                                                           {.index = 28, .buffer = argumentBuffer.handle()}}));
        for (std::uint32_t sample = 0; sample < samples; ++sample) {
            const shared::PathArguments arguments{.filmSize = scene.filmSize,
                                                  .cropOffset = scene.cropOffset,
                                                  .cropSize = scene.cropSize,
                                                  .firstPixel = first,
                                                  .laneCount = lanes,
                                                  .sampleLow = sample,
                                                  .sampleHigh = 0,
                                                  .sampleCount = 1,
                                                  .seed = seed,
                                                  .loopBudget = kMaximumCrossings,
                                                  .restart = 0,
                                                  .pauseAt = 0,
                                                  .stallLimit = 0,
                                                  .imageLanes = lanes,
                                                  .emptyFilm = 0};
            argumentBuffer.write(0, std::as_bytes(std::span(&arguments, 1)));
            device.submit([&](VkCommandBuffer commands) { pipeline.record(commands, {}, groupsCovering(lanes)); });
        }
        const auto done = features.as<shared::FeaturePixel>();
        all.insert(all.end(), done.begin(), done.end());
    }
    if (counters.as<std::uint32_t>()[shared::kCounterBvhOverflow] != 0)
        throw RuntimeFailure("the feature pass was cut short: a ray crossed too many boundaries or BVH nodes");
    return all;
}

}  // namespace parhelion::render
