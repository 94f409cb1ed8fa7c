#pragma once

#include <volk.h>

#include <filesystem>

#include "gpu/device.h"

namespace parhelion::gpu {

/// Where pipelines of this device are kept between runs; empty without a cache folder. The name hashes what DeviceInfo
/// says too: the software driver's pipelineCacheUUID tells neither its version nor its vector width.
std::filesystem::path pipelineCacheFile(const DeviceInfo& info, const VkPhysicalDeviceProperties& properties);

/// A pipeline cache holding what the file has; empty when it is missing, damaged or another device's.
VkPipelineCache loadPipelineCache(VkDevice device, const std::filesystem::path& file,
                                  const VkPhysicalDeviceProperties& properties);

/// Stores the cache for later runs. Never throws: losing it only costs time.
void storePipelineCache(VkDevice device, VkPipelineCache cache, const std::filesystem::path& file) noexcept;

}  // namespace parhelion::gpu
