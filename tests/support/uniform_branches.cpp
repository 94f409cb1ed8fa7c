#include "support/uniform_branches.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <glslang/SPIRV/spirv.hpp>
#include <optional>
#include <set>
#include <spirv-tools/optimizer.hpp>
#include <stdexcept>
#include <unordered_map>

#include "support/spirv_values.h"

namespace parhelion::test {
namespace {

using Instruction = SpirvValues::Instruction;

std::uint32_t wordOf(bool value) { return value ? 1 : 0; }
std::uint32_t wordOf(std::uint32_t value) { return value; }
std::uint32_t wordOf(float value) { return std::bit_cast<std::uint32_t>(value); }

std::vector<std::uint32_t> optimise(std::span<const std::uint32_t> spirv, const gpu::Specialisation& constants) {
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> values;
    for (const auto& [id, value] : constants) values[id] = {std::visit([](auto v) { return wordOf(v); }, value)};
    spvtools::Optimizer optimiser(SPV_ENV_VULKAN_1_2);
    std::string messages;
    optimiser.SetMessageConsumer(
        [&](spv_message_level_t, const char*, const spv_position_t&, const char* text) { messages += text; });
    optimiser.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPerformancePasses();
    spvtools::OptimizerOptions options;
    options.set_run_validator(false);  // it would have to be told of scalar layouts; drivers and their layers validate
    std::vector<std::uint32_t> result;
    if (!optimiser.Run(spirv.data(), spirv.size(), &result, options))
        throw std::runtime_error("spirv-opt: " + messages);
    return result;
}

/// A value, or the part of a composite that a path of member indices leads to.
struct Part {
    std::uint32_t id;
    std::vector<std::uint32_t> path;
    auto operator<=>(const Part&) const = default;
};

/// What a part is made from in one step.
struct Origin {
    bool varies = false;              ///< made here, by a lane, a texel, a storage buffer or the way that led here
    std::vector<Part> parts;          ///< else all of these decide it
    std::optional<std::string> word;  ///< and this word of a uniform block or of push constants
};

Origin varying() { return {.varies = true, .parts = {}, .word = {}}; }
Origin madeFrom(std::vector<Part> parts) { return {.varies = false, .parts = std::move(parts), .word = {}}; }

std::vector<std::uint32_t> without(const std::vector<std::uint32_t>& path, std::size_t first) {
    return {path.begin() + std::ptrdiff_t(std::min(first, path.size())), path.end()};
}

class Analysis {
public:
    explicit Analysis(SpirvValues values) : values_(std::move(values)) {}

    std::vector<std::string> decisions() const {
        std::vector<std::string> found;
        for (const Instruction& instruction : values_.instructions) {
            if (instruction.op == spv::OpFunctionCall) found.push_back("a function is not inlined");
            const bool decides = instruction.op == spv::OpBranchConditional || instruction.op == spv::OpSwitch;
            if (!decides && !keepsWord(instruction)) continue;
            const auto words = uniformWords({instruction.ids[decides ? 0 : 1], {}});
            const char* what = !decides                          ? "an array keeps"
                               : instruction.op == spv::OpSwitch ? "a switch on"
                                                                 : "a branch on";
            if (words && !words->empty()) found.push_back(fmt::format("{} {}", what, fmt::join(*words, ", ")));
        }
        return found;
    }

private:
    SpirvValues values_;

    std::uint32_t storageClass(const Instruction& variable) const { return variable.literals[0]; }

    /// A store of one word to what optimisation left of private variables: arrays with varying indices.
    bool keepsWord(const Instruction& instruction) const {
        if (instruction.op != spv::OpStore) return false;
        std::vector<std::uint32_t> indices;
        const Instruction* variable = values_.variableOf(instruction.ids[0], indices);
        return variable && (storageClass(*variable) == spv::StorageClassFunction ||
                            storageClass(*variable) == spv::StorageClassPrivate);
    }

    /// The uniform words that alone decide a part, none for a constant; nothing where anything else has a say.
    std::optional<std::set<std::string>> uniformWords(const Part& start) const {
        std::set<std::string> words;
        std::set<Part> seen{start};
        for (std::vector<Part> pending{start}; !pending.empty();) {
            const Part part = pending.back();
            pending.pop_back();
            const Origin origin = originOf(part);
            if (origin.varies) return std::nullopt;
            if (origin.word) words.insert(*origin.word);
            for (const Part& next : origin.parts)
                if (seen.insert(next).second) pending.push_back(next);
        }
        return words;
    }

    Origin originOf(const Part& part) const {
        const Instruction* made = values_.definition(part.id);
        if (!made) return varying();
        switch (made->op) {
            case spv::OpLoad:
                return originOfLoad(*made);
            case spv::OpPhi:
                return originOfPhi(*made, part.path);
            case spv::OpCompositeConstruct:
                return originOfConstruct(*made, part.path);
            case spv::OpCompositeExtract: {
                std::vector<std::uint32_t> path = made->literals;
                path.insert(path.end(), part.path.begin(), part.path.end());
                return madeFrom({{made->ids[0], path}});
            }
            case spv::OpCompositeInsert:
                return originOfInsert(*made, part.path);
            case spv::OpVectorShuffle:
                return originOfShuffle(*made, part.path);
            case spv::OpCopyObject:
                return madeFrom({{made->ids[0], part.path}});
            default:
                return originOfOther(*made);
        }
    }

    Origin originOfLoad(const Instruction& load) const {
        std::vector<std::uint32_t> indices;
        const Instruction* variable = values_.variableOf(load.ids[0], indices);
        if (!variable) return varying();
        const std::uint32_t where = storageClass(*variable);
        if (where == spv::StorageClassUniform || where == spv::StorageClassPushConstant) {
            // The driver wants a constant offset. A loop's counter is one once the loop is unrolled.
            for (const std::uint32_t index : indices)
                if (const auto words = uniformWords({index, {}}); !words || !words->empty()) return varying();
            return {.varies = false, .parts = {}, .word = values_.nameOf(load.ids[0])};
        }
        if (where != spv::StorageClassFunction && where != spv::StorageClassPrivate) return varying();
        Origin origin;  // whatever is stored anywhere in the variable may be what is loaded
        for (const std::uint32_t index : indices) origin.parts.push_back({index, {}});
        if (const auto stores = values_.stores.find(variable->result); stores != values_.stores.end())
            for (const std::size_t store : stores->second) {
                if (values_.instructions[store].op != spv::OpStore) return varying();
                origin.parts.push_back({values_.instructions[store].ids[1], {}});
            }
        return origin;
    }

    /// A loop's phi is its counter, made from what comes in. Elsewhere a phi tells which way control came: by a branch
    /// on uniforms, which is reported itself, or by one that varies. Unless all ways bring the same.
    Origin originOfPhi(const Instruction& phi, const std::vector<std::uint32_t>& path) const {
        std::set<std::uint32_t> incoming;
        for (std::size_t i = 0; i < phi.ids.size(); i += 2)
            if (phi.ids[i] != phi.result) incoming.insert(phi.ids[i]);
        Origin origin{.varies = incoming.size() > 1 && !values_.isLoopHeader(phi.block), .parts = {}, .word = {}};
        for (const std::uint32_t id : incoming) origin.parts.push_back({id, path});
        return origin;
    }

    Origin originOfConstruct(const Instruction& made, const std::vector<std::uint32_t>& path) const {
        Origin origin;
        const Instruction* type = values_.definition(made.type);
        // A vector's parts may be vectors: then the index alone does not name one.
        const bool whole = type->op == spv::OpTypeVector && made.ids.size() != type->literals[0];
        if (!path.empty() && !whole && path[0] < made.ids.size())
            return madeFrom({{made.ids[path[0]], without(path, 1)}});
        for (const std::uint32_t id : made.ids) origin.parts.push_back({id, {}});
        return origin;
    }

    Origin originOfInsert(const Instruction& made, const std::vector<std::uint32_t>& path) const {
        const auto& at = made.literals;
        const std::size_t common = std::min(at.size(), path.size());
        if (!std::equal(at.begin(), at.begin() + std::ptrdiff_t(common), path.begin()))
            return madeFrom({{made.ids[1], path}});
        if (path.size() >= at.size()) return madeFrom({{made.ids[0], without(path, at.size())}});
        return madeFrom({{made.ids[0], {}}, {made.ids[1], path}});
    }

    Origin originOfShuffle(const Instruction& made, const std::vector<std::uint32_t>& path) const {
        const Instruction* first = values_.definition(values_.definition(made.ids[0])->type);
        const std::uint32_t firstSize = first->literals[0];
        Origin origin;
        for (std::size_t i = 0; i < made.literals.size(); ++i) {
            if (!path.empty() && path[0] != i) continue;
            const std::uint32_t from = made.literals[i];
            origin.parts.push_back(from < firstSize ? Part{made.ids[0], {from}}
                                                    : Part{made.ids[1], {from - firstSize}});
        }
        return origin;
    }

    /// Arithmetic, which all operands decide, or something that no uniform alone can.
    Origin originOfOther(const Instruction& made) const {
        Origin origin;
        origin.varies = made.op == spv::OpFunctionCall || made.op == spv::OpFunctionParameter ||
                        made.op == spv::OpArrayLength || made.op == spv::OpVariable ||
                        (made.op >= spv::OpSampledImage && made.op <= spv::OpImageQuerySamples) ||
                        (made.op >= spv::OpAtomicLoad && made.op <= spv::OpAtomicXor) ||
                        (made.op >= spv::OpGroupNonUniformElect && made.op <= spv::OpGroupNonUniformQuadSwap);
        for (const std::uint32_t id : made.ids) {
            const Instruction* operand = values_.definition(id);
            if (operand && operand->op == spv::OpExtInstImport) continue;
            origin.parts.push_back({id, {}});
        }
        return origin;
    }
};

}  // namespace

std::vector<std::string> uniformDecisions(std::span<const std::uint32_t> spirv, const gpu::Specialisation& constants) {
    return Analysis(readSpirvValues(optimise(spirv, constants))).decisions();
}

}  // namespace parhelion::test
