#include "gpu/vulkan_error.h"

#include <fmt/format.h>

#include "base/error.h"

namespace parhelion::gpu {

const char* resultName(VkResult result) {
    switch (result) {
#define PARHELION_RESULT(name) \
    case name:                 \
        return #name;
        PARHELION_RESULT(VK_SUCCESS)
        PARHELION_RESULT(VK_NOT_READY)
        PARHELION_RESULT(VK_TIMEOUT)
        PARHELION_RESULT(VK_INCOMPLETE)
        PARHELION_RESULT(VK_ERROR_OUT_OF_HOST_MEMORY)
        PARHELION_RESULT(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        PARHELION_RESULT(VK_ERROR_INITIALIZATION_FAILED)
        PARHELION_RESULT(VK_ERROR_DEVICE_LOST)
        PARHELION_RESULT(VK_ERROR_MEMORY_MAP_FAILED)
        PARHELION_RESULT(VK_ERROR_LAYER_NOT_PRESENT)
        PARHELION_RESULT(VK_ERROR_EXTENSION_NOT_PRESENT)
        PARHELION_RESULT(VK_ERROR_FEATURE_NOT_PRESENT)
        PARHELION_RESULT(VK_ERROR_INCOMPATIBLE_DRIVER)
        PARHELION_RESULT(VK_ERROR_TOO_MANY_OBJECTS)
        PARHELION_RESULT(VK_ERROR_FORMAT_NOT_SUPPORTED)
        PARHELION_RESULT(VK_ERROR_FRAGMENTED_POOL)
        PARHELION_RESULT(VK_ERROR_OUT_OF_POOL_MEMORY)
        PARHELION_RESULT(VK_ERROR_INVALID_SHADER_NV)
        PARHELION_RESULT(VK_PIPELINE_COMPILE_REQUIRED)
#undef PARHELION_RESULT
        default:
            return "an unnamed VkResult";
    }
}

void check(VkResult result, const char* call) {
    if (result == VK_SUCCESS || result == VK_INCOMPLETE) return;
    throw RuntimeFailure(fmt::format("{} failed: {} ({})", call, resultName(result), static_cast<int>(result)));
}

}  // namespace parhelion::gpu
