#pragma once

#include <filesystem>

#include "gpu/device.h"
#include "gpu/handle.h"
#include "gpu/instance.h"

namespace parhelion::gpu {

/// Destroys the logical device, after everything made from it.
struct LogicalDevice {
    explicit LogicalDevice(VkDevice device) : handle(device) {}
    ~LogicalDevice() { vkDestroyDevice(handle, nullptr); }
    LogicalDevice(const LogicalDevice&) = delete;
    LogicalDevice& operator=(const LogicalDevice&) = delete;
    const VkDevice handle;
};

/// What a Device is made of; for host/gpu and its tests. Members are destroyed from the last to the first.
struct Device::Internals {
    explicit Internals(const DeviceOptions& options);
    ~Internals();

    ValidationLog log;
    Instance instance;
    VkPhysicalDevice physical;
    DeviceInfo info;
    VkPhysicalDeviceProperties properties{};
    VkPhysicalDeviceMemoryProperties memory{};
    std::uint64_t maxAllocation = 0;  ///< bytes of one allocation
    unsigned subgroupSize = 0;
    std::uint32_t queueFamily = 0;
    std::uint32_t timestampBits = 0;  ///< 0: the queue has no timestamps

    LogicalDevice device;
    VkQueue queue = VK_NULL_HANDLE;
    Handle<VkCommandPool, &vkDestroyCommandPool> commandPool;
    VkCommandBuffer commands = VK_NULL_HANDLE;  ///< freed with its pool
    Handle<VkFence, &vkDestroyFence> fence;
    Handle<VkQueryPool, &vkDestroyQueryPool> timestamps;
    std::filesystem::path pipelineCachePath;  ///< empty: not kept
    Handle<VkPipelineCache, &vkDestroyPipelineCache> pipelineCache;

private:
    VkPhysicalDeviceSubgroupProperties readProperties();
    VkDevice createLogicalDevice();
    void createCommands();
};

}  // namespace parhelion::gpu
