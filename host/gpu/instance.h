#pragma once

#include <volk.h>

#include <functional>
#include <string>
#include <vector>

#include "gpu/device.h"

namespace parhelion::gpu {

/// What the validation layer said, oldest first.
struct ValidationLog {
    std::vector<std::string> messages;
    std::function<void(const std::string&)> listener;  ///< told of each as well; may be empty
};

/// The Vulkan loader's instance and, with a log, the validation layer reporting to it. Move-free: address is identity.
class Instance {
public:
    enum class Drivers { kAll, kSoftwareFirst };  ///< kSoftwareFirst: others are loaded only if there is none

    /// `log` is null for no validation, otherwise outlives the instance.
    /// @throws RuntimeFailure when the loader, every driver, or the validation layer is missing.
    Instance(Drivers drivers, ValidationLog* log);
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    /// Devices in the loader's order; at least one.
    const std::vector<VkPhysicalDevice>& devices() const { return devices_; }

private:
    bool open(ValidationLog* log);
    void close();

    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    std::vector<VkPhysicalDevice> devices_;
};

DeviceInfo describe(VkPhysicalDevice device);

/// The device a user means by `name` (DeviceOptions::name). @throws InputError that lists what there is.
VkPhysicalDevice selectDevice(const Instance& instance, const std::string& name);

}  // namespace parhelion::gpu
