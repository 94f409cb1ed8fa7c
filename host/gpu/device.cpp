#include "gpu/device.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "gpu/device_internals.h"
#include "gpu/pipeline_cache.h"
#include "gpu/software_driver.h"
#include "gpu/vulkan_error.h"

namespace parhelion::gpu {
namespace {

constexpr VkSubgroupFeatureFlags kSubgroupOperations = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
                                                       VK_SUBGROUP_FEATURE_BALLOT_BIT |
                                                       VK_SUBGROUP_FEATURE_ARITHMETIC_BIT;

/// The environment decides the software driver's width while the driver loads: before the instance exists.
Instance::Drivers prepareDrivers(const DeviceOptions& options) {
    configureSoftwareDriver(options.vectorBits, options.preferredVectorBits);
    return options.name.empty() ? Instance::Drivers::kSoftwareFirst : Instance::Drivers::kAll;
}

std::uint32_t computeQueueFamily(VkPhysicalDevice device, std::uint32_t& timestampBits) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    const auto family = std::find_if(families.begin(), families.end(), [](const VkQueueFamilyProperties& properties) {
        return (properties.queueFlags & VK_QUEUE_COMPUTE_BIT) != 0;
    });
    if (family == families.end()) throw RuntimeFailure("the device has no queue for compute; choose another device");
    timestampBits = family->timestampValidBits;
    return static_cast<std::uint32_t>(family - families.begin());
}

void requireFeatures(const Device::Internals& internals, const VkPhysicalDeviceSubgroupProperties& subgroup) {
    const auto refuse = [&](const std::string& lack) {
        throw RuntimeFailure(fmt::format("device \"{}\" {}; choose another device", internals.info.name, lack));
    };
    const std::uint32_t version = internals.properties.apiVersion;
    if (version < VK_API_VERSION_1_2)
        refuse(fmt::format("has Vulkan {}.{}; 1.2 is needed", VK_API_VERSION_MAJOR(version),
                           VK_API_VERSION_MINOR(version)));
    VkPhysicalDeviceScalarBlockLayoutFeatures scalar{};
    scalar.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &scalar;
    vkGetPhysicalDeviceFeatures2(internals.physical, &features);
    if (!scalar.scalarBlockLayout) refuse("lacks scalarBlockLayout");
    if ((subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) == 0 ||
        (subgroup.supportedOperations & kSubgroupOperations) != kSubgroupOperations)
        refuse("lacks vote, ballot or arithmetic subgroup operations");
}

}  // namespace

Device::Internals::Internals(const DeviceOptions& options)
    : log{.messages = {}, .listener = options.onValidationMessage},
      instance(prepareDrivers(options), options.validation ? &log : nullptr),
      physical(selectDevice(instance, options.name)),
      info(describe(physical)),
      device(createLogicalDevice()) {
    vkGetDeviceQueue(device.handle, queueFamily, 0, &queue);
    createCommands();
    pipelineCachePath = pipelineCacheFile(info, properties);
    pipelineCache = {device.handle, loadPipelineCache(device.handle, pipelineCachePath, properties)};
}

Device::Internals::~Internals() { storePipelineCache(device.handle, pipelineCache.get(), pipelineCachePath); }

VkPhysicalDeviceSubgroupProperties Device::Internals::readProperties() {
    VkPhysicalDeviceSubgroupProperties subgroup{};
    subgroup.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
    VkPhysicalDeviceMaintenance3Properties maintenance{};
    maintenance.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
    maintenance.pNext = &subgroup;
    VkPhysicalDeviceProperties2 all{};
    all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    all.pNext = &maintenance;
    vkGetPhysicalDeviceProperties2(physical, &all);
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    properties = all.properties;
    maxAllocation = maintenance.maxMemoryAllocationSize;
    subgroupSize = subgroup.subgroupSize;
    return subgroup;
}

VkDevice Device::Internals::createLogicalDevice() {
    requireFeatures(*this, readProperties());
    queueFamily = computeQueueFamily(physical, timestampBits);
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queueInfo{};
    queueInfo.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queueInfo.queueFamilyIndex = queueFamily;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    VkPhysicalDeviceScalarBlockLayoutFeatures scalar{};
    scalar.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES;
    scalar.scalarBlockLayout = VK_TRUE;
    VkDeviceCreateInfo deviceInfo{};
    deviceInfo.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    deviceInfo.pNext = &scalar;
    deviceInfo.queueCreateInfoCount = 1;
    deviceInfo.pQueueCreateInfos = &queueInfo;
    VkDevice created = VK_NULL_HANDLE;
    check(vkCreateDevice(physical, &deviceInfo, nullptr, &created), "vkCreateDevice");
    return created;
}

void Device::Internals::createCommands() {
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.queueFamilyIndex = queueFamily;
    VkCommandPool pool = VK_NULL_HANDLE;
    check(vkCreateCommandPool(device.handle, &poolInfo, nullptr, &pool), "vkCreateCommandPool");
    commandPool = {device.handle, pool};

    VkCommandBufferAllocateInfo commandsInfo{};
    commandsInfo.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    commandsInfo.commandPool = pool;
    commandsInfo.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    commandsInfo.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device.handle, &commandsInfo, &commands), "vkAllocateCommandBuffers");

    VkFenceCreateInfo fenceInfo{};
    fenceInfo.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence created = VK_NULL_HANDLE;
    check(vkCreateFence(device.handle, &fenceInfo, nullptr, &created), "vkCreateFence");
    fence = {device.handle, created};

    if (timestampBits == 0) return;
    VkQueryPoolCreateInfo queryInfo{};
    queryInfo.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    queryInfo.queryType = VK_QUERY_TYPE_TIMESTAMP;
    queryInfo.queryCount = 2;
    VkQueryPool queries = VK_NULL_HANDLE;
    check(vkCreateQueryPool(device.handle, &queryInfo, nullptr, &queries), "vkCreateQueryPool");
    timestamps = {device.handle, queries};
}

Device::Device(const DeviceOptions& options) : internals_(std::make_unique<Internals>(options)) {}
Device::~Device() = default;

const DeviceInfo& Device::info() const { return internals_->info; }
const VkPhysicalDeviceLimits& Device::limits() const { return internals_->properties.limits; }
unsigned Device::subgroupSize() const { return internals_->subgroupSize; }
VkDevice Device::handle() const { return internals_->device.handle; }
const std::vector<std::string>& Device::validationMessages() const { return internals_->log.messages; }

std::uint64_t Device::memoryBytes() const {
    std::uint64_t largest = 0;
    for (const VkMemoryHeap& heap : std::span(internals_->memory.memoryHeaps, internals_->memory.memoryHeapCount))
        if (heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) largest = std::max<std::uint64_t>(largest, heap.size);
    return largest;
}

}  // namespace parhelion::gpu
