#pragma once

#include <volk.h>

#include <utility>

namespace parhelion::gpu {

/// Owns one Vulkan handle that a device destroys. Move-only.
template <typename T, void (*(*Destroy))(VkDevice, T, const VkAllocationCallbacks*)>
class Handle {
public:
    Handle() = default;
    Handle(VkDevice device, T value) : device_(device), value_(value) {}
    Handle(Handle&& other) noexcept : device_(other.device_), value_(std::exchange(other.value_, VK_NULL_HANDLE)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(value_, other.value_);
        return *this;
    }
    ~Handle() {
        if (value_ != VK_NULL_HANDLE) (*Destroy)(device_, value_, nullptr);
    }
    T get() const { return value_; }

private:
    VkDevice device_ = VK_NULL_HANDLE;
    T value_ = VK_NULL_HANDLE;
};

}  // namespace parhelion::gpu
