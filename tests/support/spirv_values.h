#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace parhelion::test {

/// The instructions of a SPIR-V module with what its values are made from.
struct SpirvValues {
    struct Instruction {
        std::uint32_t op = 0;
        std::uint32_t type = 0;               ///< id of the result's type, or 0
        std::uint32_t result = 0;             ///< id, or 0
        std::uint32_t block = 0;              ///< label of the block it stands in; 0 outside functions
        std::vector<std::uint32_t> ids;       ///< operands that are values, in order; of a phi (value, block) pairs
        std::vector<std::uint32_t> literals;  ///< operands that are numbers, in order
    };

    std::vector<Instruction> instructions;
    std::map<std::uint32_t, std::size_t> definitions;          ///< result -> index into instructions
    std::map<std::uint32_t, std::vector<std::size_t>> stores;  ///< variable -> OpStore, OpCopyMemory into it or a part
    std::map<std::uint32_t, std::string> names;                ///< of variables and types
    std::map<std::uint32_t, std::map<std::uint32_t, std::string>> memberNames;  ///< of structs

    const Instruction* definition(std::uint32_t id) const;
    /// Whether the block is one that a loop comes back to.
    bool isLoopHeader(std::uint32_t block) const;
    /// The variable that a pointer points into, and the index operands on the way there.
    const Instruction* variableOf(std::uint32_t pointer, std::vector<std::uint32_t>& indices) const;
    /// Name of what a pointer points to, e.g. "arguments.restart".
    std::string nameOf(std::uint32_t pointer) const;
};

/// @throws std::runtime_error for words that are no SPIR-V module.
SpirvValues readSpirvValues(std::span<const std::uint32_t> words);

}  // namespace parhelion::test
