#include "support/uniform_branches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/specialise.h"
#include "support/effect_scenes.h"
#include "support/render_scene.h"
#include "support/temporary_folder.h"

// Mesa 22's software driver compiles a kernel again at every submission, and keeps what it compiled, where a branch
// depends on uniforms alone.
namespace parhelion::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> decisionsOf(const std::string& body, const gpu::Specialisation& constants = {}) {
    const TemporaryFolder folder;
    const std::string head = R"(#version 460
        #extension GL_EXT_scalar_block_layout : require
        #extension GL_KHR_shader_subgroup_arithmetic : require
        layout(local_size_x = 64) in;
        struct Item { vec3 place; uint kind; };
        layout(push_constant, scalar) uniform Push { uint flag; uint count; float width; } push;
        layout(set = 0, binding = 0, scalar) uniform Block { uvec4 size; Item items[4]; uint number; } block;
        layout(set = 0, binding = 1, scalar) buffer Words { uint words[]; };
        layout(set = 0, binding = 2) uniform usamplerBuffer texels;
        layout(constant_id = 3) const bool fixed_ = true;
        uint lane = gl_GlobalInvocationID.x;
        uint copy;
    )";
    return uniformDecisions(gpu::compileShader(folder.write("kernel.comp", head + body)), constants);
}

TEST(UniformBranches, AreFoundWhereverTheirWordsComeFrom) {
    const auto found = [](const char* condition, const char* word) {
        const std::string body = std::string("void main() { if (") + condition +
                                 ") { atomicAdd(words[0], lane); words[lane] = words[lane + 7u]; } }";
        EXPECT_THAT(decisionsOf(body), ElementsAre(HasSubstr(word))) << condition;
    };
    found("push.flag != 0u", "push.flag");
    found("push.width * 2.0 < 1.0 || push.width == 3.0", "push.width");
    found("block.size.z > 4u", "block.size");
    found("block.items[2].kind == 1u", "block.items[2].kind");
    found("length(block.items[1].place) > push.width", "push.width");
    found("(vec4(block.items[0].place, float(lane)).zw).x > 0.0", "block.items[0].place");
    found("(block.size.x ^ block.number) == 3u", "block.number");
}

TEST(UniformBranches, AreFoundThroughFunctionsCopiesAndLoops) {
    EXPECT_THAT(decisionsOf(R"(void work(bool wanted) { if (wanted) atomicAdd(words[0], lane); }
        void main() { copy = block.number; work(copy > 2u); })"),
                ElementsAre(HasSubstr("block.number")));
    EXPECT_THAT(decisionsOf("void main() { for (uint i = 0u; i < push.count; ++i) atomicAdd(words[i], lane); }"),
                ElementsAre(HasSubstr("push.count")));
    EXPECT_THAT(decisionsOf("void main() { for (uint i = push.flag; i != 9u; i += 3u) atomicAdd(words[i], lane); }"),
                ElementsAre(HasSubstr("push.flag")));
    EXPECT_THAT(decisionsOf(R"(void main() { switch (block.number) { case 1u: atomicAdd(words[0], lane); break;
        case 2u: atomicMax(words[0], lane); break; default: atomicMin(words[0], 3u); } })"),
                ElementsAre(HasSubstr("a switch on block.number")));
    // A loop that the driver unrolls has constant offsets.
    EXPECT_THAT(decisionsOf(R"(void main() { for (uint i = 0u; i < 3u; ++i)
        if (block.items[i].kind == 2u) atomicAdd(words[i], lane); })"),
                testing::Contains(HasSubstr("block.items")));
    EXPECT_THAT(decisionsOf(R"(void main() { uint kept[6]; for (uint i = 0u; i < 6u; ++i) kept[i] = push.count;
        kept[words[lane] % 6u] = lane; words[lane] = kept[words[lane + 1u] % 6u]; })"),
                testing::Contains(HasSubstr("an array keeps push.count")));
}

TEST(UniformBranches, AreNoneWhereAnythingElseHasASay) {
    const auto none = [](const char* condition) {
        const std::string body = std::string("void main() { if (") + condition +
                                 ") { atomicAdd(words[0], lane); words[lane] = words[lane + 7u]; } }";
        EXPECT_THAT(decisionsOf(body), IsEmpty()) << condition;
    };
    none("lane < push.count");
    none("words[3] != 0u");
    none("texelFetch(texels, 0).x == push.flag");
    none("block.items[words[0]].kind == 1u");
    none("subgroupAdd(push.count) > 64u");
    none("(words[lane] == 0u ? push.flag : 3u) == 3u");
}

TEST(UniformBranches, AreJudgedWithTheConstantsOfThePipeline) {
    const std::string body = R"(void main() {
        if (fixed_ && push.flag != 0u) atomicAdd(words[0], lane);
        if (!fixed_ && block.number == 2u) atomicAdd(words[1], lane);
    })";
    EXPECT_THAT(decisionsOf(body), ElementsAre(HasSubstr("push.flag")));
    EXPECT_THAT(decisionsOf(body, {{3u, false}}), ElementsAre(HasSubstr("block.number")));
}

void expectNone(const std::string& name, const CompiledScene& scene, const EffectSet& effects) {
    for (const char* kernel : {"kernels/path_trace.comp", "kernels/features.comp"})
        for (const bool stochasticFilter : {true, false}) {
            if (!stochasticFilter && effects.on != EffectSet::all().on) continue;
            const gpu::Specialisation constants =
                render::specialise(scene, effects, {.stochasticFilter = stochasticFilter});
            EXPECT_THAT(uniformDecisions(gpu::compileShader(gpu::shaderFolder() / kernel), constants), IsEmpty())
                << name << ", " << kernel;
        }
}

TEST(UniformBranches, AreNoneInTheKernelsWithAllEffectsOrNone) {
    const CompiledScene scene = compileText(sceneXml("<emitter type=\"constant\"/>"), {8, 8});
    expectNone("none", scene, {});
    expectNone("all", scene, EffectSet::all());
}

TEST(UniformBranches, AreNoneInTheBakingOfClouds) {
    for (const bool modulates : {false, true})
        EXPECT_THAT(
            uniformDecisions(gpu::compileShader(gpu::shaderFolder() / "kernels/bake_cloud.comp"), {{128u, modulates}}),
            IsEmpty());
}

}  // namespace
}  // namespace parhelion::test
