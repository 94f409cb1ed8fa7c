#include <array>
#include <chrono>

#include "gpu/device_internals.h"
#include "gpu/vulkan_error.h"

namespace parhelion::gpu {
namespace {

using Clock = std::chrono::steady_clock;

void runAndWait(const Device::Internals& internals) {
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &internals.commands;
    const VkDevice device = internals.device.handle;
    const VkFence fence = internals.fence.get();
    check(vkResetFences(device, 1, &fence), "vkResetFences");
    check(vkQueueSubmit(internals.queue, 1, &info, fence), "vkQueueSubmit");
    check(vkWaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
}

/// Milliseconds between the two timestamps, which wrap at timestampBits.
double elapsedMs(const Device::Internals& internals) {
    std::array<std::uint64_t, 2> ticks{};
    check(vkGetQueryPoolResults(internals.device.handle, internals.timestamps.get(), 0, 2, sizeof ticks, ticks.data(),
                                sizeof ticks[0], VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
    const std::uint64_t mask = ~std::uint64_t{0} >> (64 - internals.timestampBits);
    return static_cast<double>((ticks[1] - ticks[0]) & mask) * internals.properties.limits.timestampPeriod * 1e-6;
}

}  // namespace

double Device::submit(const std::function<void(VkCommandBuffer)>& record) {
    const Internals& internals = *internals_;
    const bool timed = internals.timestampBits != 0;
    // Also ends what an exception thrown by an earlier `record` left half recorded.
    check(vkResetCommandPool(handle(), internals.commandPool.get(), 0), "vkResetCommandPool");
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(internals.commands, &begin), "vkBeginCommandBuffer");
    if (timed) {
        const VkQueryPool queries = internals.timestamps.get();
        vkCmdResetQueryPool(internals.commands, queries, 0, 2);
        vkCmdWriteTimestamp(internals.commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, queries, 0);
    }
    record(internals.commands);
    if (timed)
        vkCmdWriteTimestamp(internals.commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, internals.timestamps.get(), 1);
    check(vkEndCommandBuffer(internals.commands), "vkEndCommandBuffer");
    const Clock::time_point start = Clock::now();
    runAndWait(internals);
    if (timed) return elapsedMs(internals);
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace parhelion::gpu
