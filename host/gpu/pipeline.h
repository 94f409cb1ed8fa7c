#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "gpu/device.h"

namespace parhelion::gpu {

/// Values for specialisation constants, by constant_id; bool becomes VkBool32.
using Specialisation = std::map<std::uint32_t, std::variant<bool, std::uint32_t, float>>;

/// What to bind at a binding of set 0: a buffer for storage and uniform blocks, a view for texel buffers.
struct Binding {
    std::uint32_t index;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkBufferView view = VK_NULL_HANDLE;
};

/// Compiles GLSL with `#include` (relative to the including file, then `shaderFolder()`), caching SPIR-V on disk by content.
/// Vulkan 1.2 target. @throws RuntimeFailure with the compiler's messages, each with file:line.
std::vector<std::uint32_t> compileShader(const std::filesystem::path& file,
                                         const std::vector<std::string>& defines = {});

/// Where shaders live: $PARHELION_SHADERS, else the source tree's `shaders` known at build time, else `<prefix>/share/parhelion/shaders`.
std::filesystem::path shaderFolder();

/// A compute pipeline whose descriptor layout comes from the SPIR-V itself (set 0, push constants).
class ComputePipeline {
public:
    ComputePipeline(Device& device, const std::filesystem::path& shader, const Specialisation& constants = {},
                    const std::vector<std::string>& defines = {});
    ~ComputePipeline();
    ComputePipeline(ComputePipeline&&) noexcept;

    /// Points set 0 at these resources; every binding the shader uses must be given (asserted), others are ignored.
    void bind(std::span<const Binding> bindings);
    /// Records the dispatch and a barrier that makes its writes visible to later dispatches and the host.
    void record(VkCommandBuffer commands, std::span<const std::byte> pushConstants, std::uint32_t groups) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace parhelion::gpu
