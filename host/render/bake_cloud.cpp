#include "render/bake_cloud.h"

#include <algorithm>
#include <cassert>

#include "gpu/pipeline.h"

namespace parhelion::render {
namespace {

constexpr std::uint32_t kGroup = 64;                  // local_size_x of the kernel
constexpr std::size_t kVoxelsPerDispatch = 1u << 17;  // a fiftieth of a second on two cores

}  // namespace

shared::CloudArguments cloudArguments(const shared::CloudField& field, float largest) {
    const glm::uvec3 n = field.resolution;
    const auto longest = static_cast<float>(std::max({n.x, n.y, n.z}));
    return {.frequency = field.noiseScale * (glm::vec3(n) / longest),
            .blend = std::clamp(field.detailAmount / 0.85f, 0.0f, 1.0f),
            .voxelSize = 1.0f / glm::vec3(n),
            .sharpness = 1.0f / field.surfaceWidth,
            .detailAmount = field.detailAmount,
            .warpAmount = field.warpAmount,
            .erosionAmount = field.erosionAmount,
            .densityScale = field.densityScale,
            .densityThreshold = field.densityThreshold,
            .inverseLargest = largest > 0.0f ? 1.0f / largest : 0.0f,
            .noiseSeed = field.noiseSeed,
            .modulates = field.modulates,
            .resolution = n,
            .firstVoxel = 0,
            .voxelCount = 0};
}

std::vector<float> bakeCloud(gpu::Device& device, const shared::CloudField& field, std::span<const float> base,
                             float largest) {
    const glm::uvec3 n = field.resolution;
    std::vector<float> density(std::size_t(n.x) * n.y * n.z);
    assert(base.size() == (field.modulates ? density.size() : 0));
    const std::size_t slab = std::min(kVoxelsPerDispatch, density.size());
    gpu::Buffer baseBuffer = device.createBuffer(base.empty() ? 0 : slab * sizeof(float));
    gpu::Buffer densityBuffer = device.createBuffer(slab * sizeof(float));
    gpu::Buffer argumentBuffer = device.createBuffer(sizeof(shared::CloudArguments));
    gpu::ComputePipeline pipeline(device, gpu::shaderFolder() / "kernels/bake_cloud.comp",
                                  {{128u, field.modulates != 0}});
    const gpu::Binding bindings[] = {{.index = 0, .buffer = baseBuffer.handle()},
                                     {.index = 1, .buffer = densityBuffer.handle()},
                                     {.index = 2, .buffer = argumentBuffer.handle()}};
    pipeline.bind(bindings);
    shared::CloudArguments arguments = cloudArguments(field, largest);
    for (std::size_t first = 0; first < density.size(); first += slab) {
        const std::size_t count = std::min(slab, density.size() - first);
        arguments.firstVoxel = static_cast<std::uint32_t>(first);
        arguments.voxelCount = static_cast<std::uint32_t>(count);
        if (!base.empty()) baseBuffer.write(0, std::as_bytes(base.subspan(first, count)));
        argumentBuffer.write(0, std::as_bytes(std::span(&arguments, 1)));
        device.submit([&](VkCommandBuffer commands) { pipeline.record(commands, {}, (count + kGroup - 1) / kGroup); });
        std::ranges::copy(densityBuffer.as<float>().first(count), density.begin() + std::ptrdiff_t(first));
    }
    return density;
}

}  // namespace parhelion::render
