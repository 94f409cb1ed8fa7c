#include "gpu/spirv_interface.h"

#include <fmt/format.h>

#include <algorithm>
#include <glslang/SPIRV/spirv.hpp>

#include "base/error.h"
#include "gpu/spirv_module.h"

namespace parhelion::gpu {
namespace {

using Declaration = SpirvModule::Declaration;

/// Bytes a type takes in a block, without what the layout appends. `member`: decorations of the member that holds it.
std::uint32_t sizeOf(const SpirvModule& module, std::uint32_t type, const SpirvModule::Decorations& member) {
    const auto& [op, operands] = module.declarations.at(type);
    switch (op) {
        case spv::OpTypeInt:
        case spv::OpTypeFloat:
            return operands[1] / 8;
        case spv::OpTypeVector:
            return operands[2] * sizeOf(module, operands[1], member);
        case spv::OpTypeMatrix:
            return (operands[2] - 1) * member.at(spv::DecorationMatrixStride) + sizeOf(module, operands[1], member);
        case spv::OpTypeArray: {
            const std::uint32_t length = module.declarations.at(operands[2]).operands[2];
            return (length - 1) * module.decoration(type, spv::DecorationArrayStride, 0) +
                   sizeOf(module, operands[1], member);
        }
        case spv::OpTypeStruct: {
            std::uint32_t end = 0;
            const auto& members = module.memberDecorations.at(type);
            for (std::size_t i = 1; i < operands.size(); ++i)
                end = std::max(end,
                               members[i - 1].at(spv::DecorationOffset) + sizeOf(module, operands[i], members[i - 1]));
            return end;
        }
        default:
            throw RuntimeFailure("push constants may hold numbers, vectors, matrices, arrays and structs only");
    }
}

VkDescriptorType descriptorType(const SpirvModule& module, const std::string& name, std::uint32_t storage,
                                std::uint32_t type) {
    const Declaration* declaration = &module.declarations.at(type);
    if (storage == spv::StorageClassStorageBuffer && declaration->op == spv::OpTypeStruct)
        return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    if (storage == spv::StorageClassUniform && declaration->op == spv::OpTypeStruct)
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    if (declaration->op == spv::OpTypeSampledImage) declaration = &module.declarations.at(declaration->operands[1]);
    constexpr std::size_t kDimension = 2, kSampled = 6;
    if (declaration->op == spv::OpTypeImage && declaration->operands[kDimension] == spv::DimBuffer)
        return declaration->operands[kSampled] == 1 ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
                                                    : VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    throw RuntimeFailure(
        fmt::format("resource \"{}\": only buffer blocks and texel buffers are supported, no arrays, "
                    "images or samplers",
                    name));
}

void readVariable(const SpirvModule& module, std::uint32_t id, const std::set<std::uint32_t>& used,
                  SpirvInterface& found) {
    const std::uint32_t pointer = module.declarations.at(id).operands[0];
    const std::uint32_t storage = module.declarations.at(pointer).operands[1];
    const std::uint32_t type = module.declarations.at(pointer).operands[2];
    if (storage == spv::StorageClassPushConstant) found.pushConstantBytes = sizeOf(module, type, {});
    const bool isResource = storage == spv::StorageClassStorageBuffer || storage == spv::StorageClassUniform ||
                            storage == spv::StorageClassUniformConstant;
    if (!isResource || !used.contains(id)) return;
    const auto variableName = module.names.find(id);
    const auto typeName = module.names.find(type);
    std::string name = variableName != module.names.end() ? variableName->second : "";
    if (name.empty() && typeName != module.names.end()) name = typeName->second;
    if (module.decoration(id, spv::DecorationDescriptorSet, 0) != 0)
        throw RuntimeFailure(fmt::format("resource \"{}\" is in another descriptor set than 0", name));
    found.resources.push_back(
        {module.decoration(id, spv::DecorationBinding, 0), descriptorType(module, name, storage, type), name});
}

void readConstant(const SpirvModule& module, std::uint32_t id, const Declaration& declaration, SpirvInterface& found) {
    constexpr std::uint32_t kNone = 0xffffffff;
    const std::uint32_t constant = module.decoration(id, spv::DecorationSpecId, kNone);
    if (constant == kNone) return;
    using Type = SpirvInterface::ConstantType;
    const std::uint32_t type = module.declarations.at(declaration.operands[0]).op;
    found.constants[constant] = type == spv::OpTypeBool    ? Type::kBool
                                : type == spv::OpTypeFloat ? Type::kFloat
                                                           : Type::kInteger;
}

void readStruct(const SpirvModule& module, std::uint32_t id, SpirvInterface& found) {
    const auto name = module.names.find(id);
    const auto names = module.memberNames.find(id);
    const auto decorations = module.memberDecorations.find(id);
    if (name == module.names.end() || names == module.memberNames.end() ||
        decorations == module.memberDecorations.end())
        return;
    std::vector<SpirvInterface::Member> members;
    for (std::size_t i = 0; i < std::min(names->second.size(), decorations->second.size()); ++i) {
        const auto offset = decorations->second[i].find(spv::DecorationOffset);
        if (offset != decorations->second[i].end()) members.push_back({names->second[i], offset->second});
    }
    if (!members.empty()) found.structs.try_emplace(name->second, std::move(members));
}

}  // namespace

SpirvInterface reflect(std::span<const std::uint32_t> spirv) {
    const SpirvModule module = parseSpirv(spirv);
    const std::set<std::uint32_t> used = module.usedVariables();
    SpirvInterface found;
    for (const auto& [id, declaration] : module.declarations) {
        if (declaration.op == spv::OpVariable) readVariable(module, id, used, found);
        if (declaration.op == spv::OpTypeStruct) readStruct(module, id, found);
        readConstant(module, id, declaration, found);
    }
    std::sort(found.resources.begin(), found.resources.end(),
              [](const auto& a, const auto& b) { return a.binding < b.binding; });
    return found;
}

}  // namespace parhelion::gpu
