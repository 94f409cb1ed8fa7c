#pragma once

#include <volk.h>

namespace parhelion::gpu {

/// The enumerant as text, e.g. "VK_ERROR_DEVICE_LOST".
const char* resultName(VkResult result);

/// Passes VK_SUCCESS and VK_INCOMPLETE. @throws RuntimeFailure "vkSomething failed: VK_ERROR_..." otherwise.
void check(VkResult result, const char* call);

}  // namespace parhelion::gpu
