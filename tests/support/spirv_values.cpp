#include "support/spirv_values.h"

#include <fmt/format.h>
#include <spirv-tools/libspirv.h>

#include <glslang/SPIRV/spirv.hpp>
#include <memory>
#include <stdexcept>

namespace parhelion::test {
namespace {

using Instruction = SpirvValues::Instruction;

std::string textAt(const spv_parsed_instruction_t& parsed, std::size_t operand) {
    return reinterpret_cast<const char*>(parsed.words + parsed.operands[operand].offset);
}

struct Reader {
    SpirvValues values;
    std::uint32_t block = 0;

    void read(const spv_parsed_instruction_t& parsed) {
        const auto op = parsed.opcode;
        if (op == spv::OpName) values.names[parsed.words[1]] = textAt(parsed, 1);
        if (op == spv::OpMemberName) values.memberNames[parsed.words[1]][parsed.words[2]] = textAt(parsed, 2);
        Instruction instruction{.op = parsed.opcode,
                                .type = parsed.type_id,
                                .result = parsed.result_id,
                                .block = block,
                                .ids = {},
                                .literals = {}};
        for (std::size_t i = 0; i < parsed.num_operands; ++i) {
            const spv_parsed_operand_t& operand = parsed.operands[i];
            const std::uint32_t word = parsed.words[operand.offset];
            if (operand.type == SPV_OPERAND_TYPE_ID)
                instruction.ids.push_back(word);
            else if (operand.type == SPV_OPERAND_TYPE_LITERAL_INTEGER ||
                     operand.type == SPV_OPERAND_TYPE_TYPED_LITERAL_NUMBER ||
                     operand.type == SPV_OPERAND_TYPE_STORAGE_CLASS)
                instruction.literals.push_back(word);
        }
        if (op == spv::OpLabel) block = parsed.result_id;
        if (op == spv::OpFunctionEnd) block = 0;
        if (parsed.result_id != 0) values.definitions[parsed.result_id] = values.instructions.size();
        values.instructions.push_back(std::move(instruction));
    }

    void collectStores() {
        for (std::size_t i = 0; i < values.instructions.size(); ++i) {
            const auto op = values.instructions[i].op;
            if (op != spv::OpStore && op != spv::OpCopyMemory) continue;
            std::vector<std::uint32_t> indices;
            if (const Instruction* variable = values.variableOf(values.instructions[i].ids[0], indices))
                values.stores[variable->result].push_back(i);
        }
    }
};

spv_result_t readInstruction(void* reader, const spv_parsed_instruction_t* parsed) {
    static_cast<Reader*>(reader)->read(*parsed);
    return SPV_SUCCESS;
}

}  // namespace

const Instruction* SpirvValues::definition(std::uint32_t id) const {
    const auto found = definitions.find(id);
    return found == definitions.end() ? nullptr : &instructions[found->second];
}

bool SpirvValues::isLoopHeader(std::uint32_t block) const {
    const auto label = definitions.find(block);
    if (label == definitions.end()) return false;
    for (std::size_t i = label->second + 1; i < instructions.size() && instructions[i].block == block; ++i)
        if (instructions[i].op == spv::OpLoopMerge) return true;
    return false;
}

const Instruction* SpirvValues::variableOf(std::uint32_t pointer, std::vector<std::uint32_t>& indices) const {
    const Instruction* at = definition(pointer);
    while (at &&
           (at->op == spv::OpAccessChain || at->op == spv::OpInBoundsAccessChain || at->op == spv::OpCopyObject)) {
        indices.insert(indices.begin(), at->ids.begin() + 1, at->ids.end());
        at = definition(at->ids[0]);
    }
    return at && at->op == spv::OpVariable ? at : nullptr;
}

std::string SpirvValues::nameOf(std::uint32_t pointer) const {
    std::vector<std::uint32_t> indices;
    const Instruction* variable = variableOf(pointer, indices);
    if (!variable) return "?";
    const auto named = names.find(variable->result);
    std::string text = named == names.end() ? "" : named->second;
    const Instruction* type = definition(definition(variable->type)->ids[0]);
    for (const std::uint32_t index : indices) {
        const Instruction* constant = definition(index);
        const bool known = constant && !constant->literals.empty();
        const auto op = type->op;
        if (op == spv::OpTypeStruct && known) {
            const std::uint32_t member = constant->literals[0];
            const auto members = memberNames.find(type->result);
            text += members == memberNames.end() ? fmt::format(".{}", member) : "." + members->second.at(member);
            type = definition(type->ids[member]);
        } else {
            text += known ? fmt::format("[{}]", constant->literals[0]) : "[?]";
            if (!type->ids.empty()) type = definition(type->ids[0]);
        }
    }
    return text.starts_with('.') ? text.substr(1) : text;
}

SpirvValues readSpirvValues(std::span<const std::uint32_t> words) {
    const std::unique_ptr<spv_context_t, void (*)(spv_context)> context(spvContextCreate(SPV_ENV_VULKAN_1_2),
                                                                        &spvContextDestroy);
    Reader reader;
    spv_diagnostic diagnostic = nullptr;
    const spv_result_t result =
        spvBinaryParse(context.get(), &reader, words.data(), words.size(), nullptr, &readInstruction, &diagnostic);
    const std::string message = diagnostic ? diagnostic->error : "";
    spvDiagnosticDestroy(diagnostic);
    if (result != SPV_SUCCESS) throw std::runtime_error("SPIR-V: " + message);
    reader.collectStores();
    return std::move(reader.values);
}

}  // namespace parhelion::test
