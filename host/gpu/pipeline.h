#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
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

/// Compiles GLSL with `#include` (relative to the including file, then `shaderFolder()`), caching SPIR-V on disk by
/// content. Vulkan 1.2 target; `defines` are "NAME" or "NAME=value". GL_GOOGLE_include_directive is already on. @throws
/// RuntimeFailure with the compiler's messages, each with file:line.
std::vector<std::uint32_t> compileShader(const std::filesystem::path& file,
                                         const std::vector<std::string>& defines = {});

/// Where shaders live: $PARHELION_SHADERS, else the source tree's `shaders` known at build time, else
/// `<prefix>/share/parhelion/shaders`.
std::filesystem::path shaderFolder();

/// A compute pipeline whose descriptor layout comes from the SPIR-V itself (set 0, push constants).
/// Bindings that no function reachable from `main` touches are no part of it.
class ComputePipeline {
public:
    /// Constants that the module does not declare are left out; the others must have its types.
    /// @throws RuntimeFailure for a shader that does not compile or that the device refuses.
    ComputePipeline(Device& device, const std::filesystem::path& shader, const Specialisation& constants = {},
                    const std::vector<std::string>& defines = {});
    ~ComputePipeline();
    ComputePipeline(ComputePipeline&&) noexcept;

    /// Points set 0 at these resources; bindings the shader does not use are ignored. Not between submit and its end.
    /// @throws RuntimeFailure when one the shader uses is missing, or larger than the device can bind.
    void bind(std::span<const Binding> bindings);
    /// Records the dispatch and a barrier that makes its writes visible to later dispatches and the host.
    /// @throws RuntimeFailure unless pushConstants has the declared size and the device takes that many groups.
    void record(VkCommandBuffer commands, std::span<const std::byte> pushConstants, std::uint32_t groups) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace parhelion::gpu
