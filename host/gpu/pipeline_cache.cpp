#include "gpu/pipeline_cache.h"

#include <fmt/format.h>

#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "gpu/cache.h"
#include "gpu/vulkan_error.h"

namespace parhelion::gpu {
namespace {

/// Drivers must refuse foreign data themselves, but some crash on it: look at the header first.
bool isMadeFor(std::span<const std::byte> data, const VkPhysicalDeviceProperties& properties) {
    VkPipelineCacheHeaderVersionOne header;
    if (data.size() < sizeof header) return false;
    std::memcpy(&header, data.data(), sizeof header);
    return header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendorID == properties.vendorID &&
           header.deviceID == properties.deviceID &&
           std::memcmp(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

}  // namespace

std::filesystem::path pipelineCacheFile(const DeviceInfo& info, const VkPhysicalDeviceProperties& properties) {
    const std::filesystem::path folder = cacheFolder("pipelines");
    if (folder.empty()) return {};
    std::string uuid;
    for (const std::uint8_t byte : properties.pipelineCacheUUID) uuid += fmt::format("{:02x}", byte);
    const std::uint64_t name = contentHash(info.name + info.driver);
    return folder / fmt::format("{}-{:x}-{:016x}.bin", uuid, properties.driverVersion, name);
}

VkPipelineCache loadPipelineCache(VkDevice device, const std::filesystem::path& file,
                                  const VkPhysicalDeviceProperties& properties) {
    std::vector<std::byte> data = readCacheFile(file);
    if (!isMadeFor(data, properties)) data.clear();
    VkPipelineCacheCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
    info.initialDataSize = data.size();
    info.pInitialData = data.data();
    VkPipelineCache cache = VK_NULL_HANDLE;
    check(vkCreatePipelineCache(device, &info, nullptr, &cache), "vkCreatePipelineCache");
    return cache;
}

void storePipelineCache(VkDevice device, VkPipelineCache cache, const std::filesystem::path& file) noexcept {
    try {
        if (file.empty()) return;
        std::size_t size = 0;
        check(vkGetPipelineCacheData(device, cache, &size, nullptr), "vkGetPipelineCacheData");
        std::vector<std::byte> data(size);
        check(vkGetPipelineCacheData(device, cache, &size, data.data()), "vkGetPipelineCacheData");
        data.resize(size);
        if (data != readCacheFile(file)) writeCacheFile(file, data);
    } catch (const std::exception&) {
        // The next run compiles again.
    }
}

}  // namespace parhelion::gpu
