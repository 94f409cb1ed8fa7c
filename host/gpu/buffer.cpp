#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "gpu/device_internals.h"
#include "gpu/vulkan_error.h"

namespace parhelion::gpu {
namespace {

constexpr VkBufferUsageFlags kUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
    VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

double mebibytes(std::uint64_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

/// Bytes of one texel; 0 for a format no kernel reads.
std::size_t texelBytes(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R8_UNORM:
        case VK_FORMAT_R8_UINT:
            return 1;
        case VK_FORMAT_R16_UNORM:
        case VK_FORMAT_R16_UINT:
        case VK_FORMAT_R16_SFLOAT:
        case VK_FORMAT_R8G8_UNORM:
            return 2;
        case VK_FORMAT_R32_SFLOAT:
        case VK_FORMAT_R32_UINT:
        case VK_FORMAT_R32_SINT:
            return 4;
        case VK_FORMAT_R8G8B8A8_UNORM:
        case VK_FORMAT_R16G16_UNORM:
            return 4;
        case VK_FORMAT_R32G32_SFLOAT:
        case VK_FORMAT_R32G32_UINT:
        case VK_FORMAT_R16G16B16A16_SFLOAT:
            return 8;
        case VK_FORMAT_R16G16B16A16_UNORM:
            return 8;
        case VK_FORMAT_R32G32B32A32_SFLOAT:
        case VK_FORMAT_R32G32B32A32_UINT:
        case VK_FORMAT_R32G32B32A32_SINT:
            return 16;
        default:
            return 0;
    }
}

/// Host-visible, host-coherent memory types the buffer can use; device-local ones first.
std::vector<std::uint32_t> usableMemoryTypes(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t allowed) {
    constexpr VkMemoryPropertyFlags needed = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const auto flagsOf = [&](std::uint32_t type) { return memory.memoryTypes[type].propertyFlags; };
    std::vector<std::uint32_t> types;
    for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type)
        if ((allowed >> type & 1) != 0 && (flagsOf(type) & needed) == needed) types.push_back(type);
    std::stable_partition(types.begin(), types.end(), [&](std::uint32_t type) {
        return (flagsOf(type) & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) != 0;
    });
    return types;
}

VkDeviceMemory allocate(const Device::Internals& internals, const VkMemoryRequirements& needs) {
    VkResult result = VK_ERROR_FEATURE_NOT_PRESENT;
    for (const std::uint32_t type : usableMemoryTypes(internals.memory, needs.memoryTypeBits)) {
        VkMemoryAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        info.allocationSize = needs.size;
        info.memoryTypeIndex = type;
        VkDeviceMemory memory = VK_NULL_HANDLE;
        result = vkAllocateMemory(internals.device.handle, &info, nullptr, &memory);
        if (result == VK_SUCCESS) return memory;
    }
    throw RuntimeFailure(
        fmt::format("vkAllocateMemory of {:.1f} MiB failed: {}; render a smaller part at once, or use "
                    "smaller grids, images or meshes",
                    mebibytes(needs.size), resultName(result)));
}

}  // namespace

Buffer Device::createBuffer(std::size_t bytes) {
    const std::uint64_t limit = std::min<std::uint64_t>(internals_->maxAllocation, memoryBytes());
    if (bytes > limit)
        throw RuntimeFailure(
            fmt::format("a buffer of {:.1f} MiB exceeds the {:.1f} MiB device \"{}\" can allocate at "
                        "once; use a smaller grid, image or mesh, or another device",
                        mebibytes(bytes), mebibytes(limit), info().name));
    Buffer buffer;
    buffer.device_ = handle();
    buffer.size_ = bytes;
    buffer.maxTexels_ = limits().maxTexelBufferElements;
    VkBufferCreateInfo bufferInfo{};
    bufferInfo.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    bufferInfo.size = std::max<std::size_t>(bytes, kEmptyBufferBytes);
    bufferInfo.usage = kUsage;
    bufferInfo.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    check(vkCreateBuffer(handle(), &bufferInfo, nullptr, &buffer.buffer_), "vkCreateBuffer");
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(handle(), buffer.buffer_, &needs);
    buffer.memory_ = allocate(*internals_, needs);
    check(vkBindBufferMemory(handle(), buffer.buffer_, buffer.memory_, 0), "vkBindBufferMemory");
    check(vkMapMemory(handle(), buffer.memory_, 0, VK_WHOLE_SIZE, 0, &buffer.mapped_), "vkMapMemory");
    std::memset(buffer.mapped_, 0, bufferInfo.size);
    return buffer;
}

Buffer::Buffer(Buffer&& other) noexcept { *this = std::move(other); }

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(buffer_, other.buffer_);
    std::swap(memory_, other.memory_);
    std::swap(mapped_, other.mapped_);
    std::swap(size_, other.size_);
    std::swap(maxTexels_, other.maxTexels_);
    std::swap(views_, other.views_);
    return *this;
}

Buffer::~Buffer() {
    for (const VkBufferView view : views_) vkDestroyBufferView(device_, view, nullptr);
    if (buffer_ != VK_NULL_HANDLE) vkDestroyBuffer(device_, buffer_, nullptr);
    if (memory_ != VK_NULL_HANDLE) vkFreeMemory(device_, memory_, nullptr);
}

void Buffer::write(std::size_t offset, std::span<const std::byte> bytes) {
    assert(offset <= size_ && bytes.size() <= size_ - offset);
    if (!bytes.empty()) std::memcpy(static_cast<std::byte*>(mapped_) + offset, bytes.data(), bytes.size());
}

VkBufferView Buffer::texelView(VkFormat format, std::size_t offset, std::size_t bytes) {
    const std::size_t texel = texelBytes(format);
    assert(texel != 0 && offset <= size_);
    const std::size_t length = bytes == VK_WHOLE_SIZE ? (size_ - offset) / texel * texel : bytes;
    if (length / texel > maxTexels_)
        throw RuntimeFailure(
            fmt::format("a table of {} texels exceeds the device's {} (maxTexelBufferElements); use a "
                        "smaller grid, image or mesh, or another device",
                        length / texel, maxTexels_));
    VkBufferViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
    info.buffer = buffer_;
    info.format = format;
    info.offset = size_ == 0 ? 0 : offset;
    info.range = length == 0 ? kEmptyBufferBytes : length;
    VkBufferView view = VK_NULL_HANDLE;
    check(vkCreateBufferView(device_, &info, nullptr, &view), "vkCreateBufferView");
    views_.push_back(view);
    return view;
}

}  // namespace parhelion::gpu
