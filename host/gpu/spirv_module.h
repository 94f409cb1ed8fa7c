#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace parhelion::gpu {

/// The declarations of a SPIR-V module that an interface is read from, by result id; operands as in the
/// specification's tables (https://registry.khronos.org/SPIR-V/specs/unified1/SPIRV.html), first operand at [0].
struct SpirvModule {
    struct Declaration {
        std::uint32_t op;
        std::vector<std::uint32_t> operands;
    };
    struct Function {
        std::set<std::uint32_t> calls;      ///< functions
        std::set<std::uint32_t> variables;  ///< module-scope variables it reads, writes or passes on
    };
    using Decorations = std::map<std::uint32_t, std::uint32_t>;  ///< decoration -> its literal, 0 without one

    std::map<std::uint32_t, Declaration> declarations;  ///< types, constants, variables
    std::map<std::uint32_t, std::string> names;
    std::map<std::uint32_t, std::vector<std::string>> memberNames;
    std::map<std::uint32_t, Decorations> decorations;
    std::map<std::uint32_t, std::vector<Decorations>> memberDecorations;
    std::map<std::uint32_t, Function> functions;
    std::uint32_t entryPoint = 0;

    /// The literal of a decoration, or `otherwise` where the id has none.
    std::uint32_t decoration(std::uint32_t id, std::uint32_t kind, std::uint32_t otherwise) const;
    /// Variables in static use by the entry point: by its functions, however deep.
    std::set<std::uint32_t> usedVariables() const;
};

/// @throws RuntimeFailure for words that are no SPIR-V module.
SpirvModule parseSpirv(std::span<const std::uint32_t> words);

}  // namespace parhelion::gpu
