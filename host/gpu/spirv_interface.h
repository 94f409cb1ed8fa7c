#pragma once

#include <volk.h>

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace parhelion::gpu {

/// What a compute shader expects of its host, read from its SPIR-V.
struct SpirvInterface {
    struct Resource {
        std::uint32_t binding;
        VkDescriptorType type;
        std::string name;
    };
    enum class ConstantType { kBool, kInteger, kFloat };
    struct Member {
        std::string name;
        std::uint32_t offset;  ///< bytes from the start of its struct
    };

    std::vector<Resource> resources;                  ///< of set 0, in use by `main`; bindings ascend
    std::uint32_t pushConstantBytes = 0;              ///< of the block as declared; 0: none
    std::map<std::uint32_t, ConstantType> constants;  ///< specialisation constants by constant_id
    /// Explicitly laid out structs by name, members in order; a name used twice keeps its first layout.
    std::map<std::string, std::vector<Member>> structs;
};

/// @throws RuntimeFailure for what pipelines here do not support: other sets, arrays of resources, images, samplers.
SpirvInterface reflect(std::span<const std::uint32_t> spirv);

}  // namespace parhelion::gpu
