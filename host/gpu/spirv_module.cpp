#include "gpu/spirv_module.h"

#include <glslang/SPIRV/spirv.hpp>

#include "base/error.h"

namespace parhelion::gpu {
namespace {

using Operands = std::span<const std::uint32_t>;

/// A literal string: bytes of consecutive words, ended by a zero byte.
std::string literalString(Operands operands) {
    std::string text;
    for (const std::uint32_t word : operands)
        for (int shift = 0; shift < 32; shift += 8) {
            const char c = static_cast<char>(word >> shift & 0xff);
            if (c == 0) return text;
            text += c;
        }
    return text;
}

template <typename T>
T& at(std::vector<T>& values, std::size_t index) {
    if (values.size() <= index) values.resize(index + 1);
    return values[index];
}

/// Names, decorations and the entry point.
void readAnnotation(SpirvModule& module, std::uint32_t op, Operands operands) {
    const auto literal = [&](std::size_t index) { return index < operands.size() ? operands[index] : 0; };
    switch (op) {
        case spv::OpEntryPoint:
            module.entryPoint = operands[1];
            break;
        case spv::OpName:
            module.names[operands[0]] = literalString(operands.subspan(1));
            break;
        case spv::OpMemberName:
            at(module.memberNames[operands[0]], operands[1]) = literalString(operands.subspan(2));
            break;
        case spv::OpDecorate:
            module.decorations[operands[0]][operands[1]] = literal(2);
            break;
        case spv::OpMemberDecorate:
            at(module.memberDecorations[operands[0]], operands[1])[operands[2]] = literal(3);
            break;
        default:
            break;
    }
}

/// Types declare their id first; constants and variables after their type.
void readDeclaration(SpirvModule& module, std::uint32_t op, Operands operands) {
    std::size_t idAt = 0;
    switch (op) {
        case spv::OpTypeBool:
        case spv::OpTypeInt:
        case spv::OpTypeFloat:
        case spv::OpTypeVector:
        case spv::OpTypeMatrix:
        case spv::OpTypeImage:
        case spv::OpTypeSampler:
        case spv::OpTypeSampledImage:
        case spv::OpTypeArray:
        case spv::OpTypeRuntimeArray:
        case spv::OpTypeStruct:
        case spv::OpTypePointer:
            break;
        case spv::OpConstant:
        case spv::OpSpecConstant:
        case spv::OpSpecConstantTrue:
        case spv::OpSpecConstantFalse:
        case spv::OpVariable:
            idAt = 1;
            break;
        default:
            return;
    }
    module.declarations[operands[idAt]] = {op, {operands.begin(), operands.end()}};
}

/// Where an instruction can name a module-scope variable of a resource.
void readUse(SpirvModule::Function& function, std::uint32_t op, Operands operands) {
    switch (op) {
        case spv::OpStore:
            function.variables.insert(operands[0]);
            break;
        case spv::OpLoad:
        case spv::OpAccessChain:
        case spv::OpInBoundsAccessChain:
        case spv::OpArrayLength:
        case spv::OpImageTexelPointer:
        case spv::OpCopyObject:
            function.variables.insert(operands[2]);
            break;
        case spv::OpCopyMemory:
            function.variables.insert({operands[0], operands[1]});
            break;
        case spv::OpFunctionCall:
            function.calls.insert(operands[2]);
            function.variables.insert(operands.begin() + 3, operands.end());
            break;
        default:
            break;
    }
}

}  // namespace

std::uint32_t SpirvModule::decoration(std::uint32_t id, std::uint32_t kind, std::uint32_t otherwise) const {
    const auto all = decorations.find(id);
    if (all == decorations.end()) return otherwise;
    const auto found = all->second.find(kind);
    return found == all->second.end() ? otherwise : found->second;
}

std::set<std::uint32_t> SpirvModule::usedVariables() const {
    std::set<std::uint32_t> used, visited;
    std::vector<std::uint32_t> pending{entryPoint};
    while (!pending.empty()) {
        const std::uint32_t id = pending.back();
        pending.pop_back();
        if (!visited.insert(id).second) continue;
        const Function& function = functions.at(id);
        used.insert(function.variables.begin(), function.variables.end());
        pending.insert(pending.end(), function.calls.begin(), function.calls.end());
    }
    return used;
}

SpirvModule parseSpirv(std::span<const std::uint32_t> words) {
    constexpr std::size_t kHeaderWords = 5;
    if (words.size() < kHeaderWords || words[0] != spv::MagicNumber) throw RuntimeFailure("these words are no SPIR-V");
    SpirvModule module;
    SpirvModule::Function* function = nullptr;
    for (std::size_t i = kHeaderWords; i < words.size();) {
        const std::uint32_t op = words[i] & spv::OpCodeMask;
        const std::size_t length = words[i] >> spv::WordCountShift;
        if (length == 0 || length > words.size() - i) throw RuntimeFailure("these SPIR-V words are cut short");
        const Operands operands = words.subspan(i + 1, length - 1);
        if (op == spv::OpFunction) function = &module.functions[operands[1]];
        if (function) {
            readUse(*function, op, operands);
        } else {
            readAnnotation(module, op, operands);
            readDeclaration(module, op, operands);
        }
        i += length;
    }
    if (!module.functions.contains(module.entryPoint)) throw RuntimeFailure("this SPIR-V has no entry point");
    return module;
}

}  // namespace parhelion::gpu
