#pragma once

#include <volk.h>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gpu/handle.h"

namespace parhelion::gpu {

/// A device a user can name.
struct DeviceInfo {
    std::string name, driver, type;  ///< e.g. "llvmpipe (LLVM 15.0.6, 512 bits)", "llvmpipe Mesa 22.3.6", "cpu"
    bool software = false;
};

struct DeviceOptions {
    std::string name = {};    ///< case-insensitive part of the device name, or its index; empty: software driver first
    bool validation = false;  ///< Khronos validation layer; every message is kept in validationMessages()
    /// Software driver's vector width: 128, 256, 512; 0: the widest the CPU has. First Device of a process decides.
    unsigned vectorBits = 0;
    unsigned preferredVectorBits = 512;  ///< the widest to take where vectorBits is 0
    /// Told of each validation message as well, those during the device's destruction included.
    std::function<void(const std::string&)> onValidationMessage = {};
};

/// Instance, device, queue, command buffer, pipeline cache and limits. Outlives its buffers and pipelines.
class Device {
public:
    /// @throws InputError when options.name or vectorBits cannot be had, RuntimeFailure when the loader, a driver,
    /// the validation layer or a needed feature (Vulkan 1.2, scalarBlockLayout, subgroup operations) is missing.
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const;
    const VkPhysicalDeviceLimits& limits() const;
    unsigned subgroupSize() const;
    std::uint64_t memoryBytes() const;  ///< largest device-local heap
    VkDevice handle() const;
    const std::vector<std::string>& validationMessages() const;

    /// Host-visible, host-coherent memory for storage, uniform, texel and transfer use, zero-initialised. An empty
    /// buffer (0 bytes) can be bound and viewed. @throws RuntimeFailure beyond what the device can allocate.
    class Buffer createBuffer(std::size_t bytes);
    /// Records with `record`, submits, waits. Returns the device time in milliseconds (timestamps). After an
    /// exception by `record`, which passes through, nothing has run.
    double submit(const std::function<void(VkCommandBuffer)>& record);

    struct Internals;
    Internals& internals() { return *internals_; }  ///< for host/gpu and its tests: gpu/device_internals.h

private:
    std::unique_ptr<Internals> internals_;
};

/// Lists what is there, without opening a device; DeviceOptions::name takes an index into it.
/// @throws RuntimeFailure that says what to install when there is nothing.
std::vector<DeviceInfo> listDevices();

/// Vulkan has no empty buffers: those of 0 bytes hold this many.
inline constexpr std::size_t kEmptyBufferBytes = 16;

/// A mapped buffer; move-only. data() stays valid for its life.
class Buffer {
public:
    Buffer() = default;
    Buffer(Buffer&&) noexcept;
    Buffer& operator=(Buffer&&) noexcept;
    ~Buffer();

    std::size_t size() const { return size_; }
    VkBuffer handle() const { return buffer_; }
    void* data() { return mapped_; }
    template <typename T>
    std::span<T> as() {
        return {static_cast<T*>(mapped_), size_ / sizeof(T)};
    }
    /// Copies into [offset, offset + bytes.size()), which must lie inside (asserted).
    void write(std::size_t offset, std::span<const std::byte> bytes);
    /// A texel view of [offset, offset + bytes), whole texels; owned by the buffer.
    /// @throws RuntimeFailure beyond maxTexelBufferElements.
    VkBufferView texelView(VkFormat format, std::size_t offset = 0, std::size_t bytes = VK_WHOLE_SIZE);

private:
    friend class Device;
    VkDevice device_ = VK_NULL_HANDLE;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    void* mapped_ = nullptr;
    std::size_t size_ = 0;
    std::size_t maxTexels_ = 0;
    std::vector<VkBufferView> views_;
};

}  // namespace parhelion::gpu
