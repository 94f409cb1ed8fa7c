#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdlib>
#include <numeric>

#include "base/error.h"
#include "gpu/cache.h"
#include "gpu/device_internals.h"
#include "support/gpu_fixture.h"
#include "support/scoped_variable.h"
#include "support/temporary_folder.h"

namespace parhelion {
namespace {

namespace fs = std::filesystem;
using test::testDevice;
using testing::HasSubstr;

const std::string kHeader =
    "#version 460\n#extension GL_EXT_scalar_block_layout : require\nlayout(local_size_x = 64) in;\n";

class GpuPipeline : public testing::Test {
protected:
    test::TemporaryFolder folder_;
    gpu::Device& device_ = testDevice();

    gpu::ComputePipeline pipelineOf(const std::string& body, const gpu::Specialisation& constants = {}) {
        return {device_, folder_.write("kernel.comp", kHeader + body), constants};
    }

    /// Runs one group; returns the first `count` words of binding 0.
    std::vector<std::uint32_t> run(const std::string& body, std::size_t count,
                                   const gpu::Specialisation& constants = {}, std::vector<gpu::Binding> bindings = {}) {
        gpu::Buffer result = device_.createBuffer(count * sizeof(std::uint32_t));
        bindings.push_back({.index = 0, .buffer = result.handle()});
        gpu::ComputePipeline pipeline = pipelineOf(body, constants);
        pipeline.bind(bindings);
        device_.submit([&](VkCommandBuffer commands) { pipeline.record(commands, {}, 1); });
        const auto words = result.as<std::uint32_t>();
        return {words.begin(), words.end()};
    }

    std::string failureOf(const auto& action) {
        try {
            action();
        } catch (const RuntimeFailure& failure) {
            return failure.what();
        }
        return "no failure";
    }
};

const std::string kResult = "layout(set = 0, binding = 0, scalar) buffer Result { uint result[]; };\n";

TEST_F(GpuPipeline, AddsOneAndOne) {
    EXPECT_EQ(run(kResult + "void main() { if (gl_LocalInvocationIndex == 0u) result[0] = 1u + 1u; }", 1).at(0), 2u);
}

TEST_F(GpuPipeline, RunsEveryInvocationOfEveryGroup) {
    gpu::Buffer result = device_.createBuffer(3 * 64 * 4);
    gpu::ComputePipeline pipeline =
        pipelineOf(kResult + "void main() { result[gl_GlobalInvocationID.x] = gl_GlobalInvocationID.x; }");
    pipeline.bind(std::array{gpu::Binding{.index = 0, .buffer = result.handle()}});
    device_.submit([&](VkCommandBuffer commands) { pipeline.record(commands, {}, 3); });
    std::vector<std::uint32_t> expected(3 * 64);
    std::iota(expected.begin(), expected.end(), 0u);
    EXPECT_THAT(result.as<std::uint32_t>(), testing::ElementsAreArray(expected));
}

/// The validation layer misses hazards between two dispatches, but not between a dispatch and a copy.
TEST_F(GpuPipeline, MakesWritesVisibleToLaterCommands) {
    gpu::Buffer result = device_.createBuffer(64 * 4);
    gpu::Buffer copy = device_.createBuffer(64 * 4);
    gpu::ComputePipeline pipeline =
        pipelineOf(kResult + "void main() { uint i = gl_LocalInvocationIndex; result[i] = 2u * result[i] + i; }");
    pipeline.bind(std::array{gpu::Binding{.index = 0, .buffer = result.handle()}});
    device_.submit([&](VkCommandBuffer commands) {
        for (int i = 0; i < 3; ++i) pipeline.record(commands, {}, 1);
        const VkBufferCopy region{0, 0, copy.size()};
        vkCmdCopyBuffer(commands, result.handle(), copy.handle(), 1, &region);
    });
    EXPECT_EQ(device_.validationMessages(), std::vector<std::string>());
    EXPECT_EQ(copy.as<std::uint32_t>()[63], 63u * 7);  // i, 2 i + i, 2 (3 i) + i
}

TEST_F(GpuPipeline, SubgroupHasTheSizeTheDeviceTells) {
    const auto words =
        run("#extension GL_KHR_shader_subgroup_basic : require\n"
            "#extension GL_KHR_shader_subgroup_arithmetic : require\n" +
                kResult +
                "void main() { uint lanes = subgroupAdd(1u);"
                " if (gl_LocalInvocationIndex == 0u) { result[0] = gl_SubgroupSize; result[1] = lanes; } }",
            2);
    EXPECT_EQ(words.at(0), device_.subgroupSize());
    EXPECT_EQ(words.at(1), device_.subgroupSize());
}

const std::string kConstants = kResult + R"(
    layout(constant_id = 3) const bool flag = true;
    layout(constant_id = 5) const uint count = 7u;
    layout(constant_id = 64) const float scale = 0.5;
    void main() {
        if (gl_LocalInvocationIndex != 0u) return;
        result[0] = uint(flag);
        result[1] = count;
        result[2] = floatBitsToUint(scale);
    })";

TEST_F(GpuPipeline, KeepsDefaultsOfConstantsNotGiven) {
    EXPECT_THAT(run(kConstants, 3), testing::ElementsAre(1u, 7u, std::bit_cast<std::uint32_t>(0.5f)));
}

TEST_F(GpuPipeline, SpecialisesConstantsById) {
    const gpu::Specialisation constants{{3, false}, {5, 4000000000u}, {64, -3.25f}, {99, 1u}};
    EXPECT_THAT(run(kConstants, 3, constants),
                testing::ElementsAre(0u, 4000000000u, std::bit_cast<std::uint32_t>(-3.25f)));
}

TEST_F(GpuPipeline, RefusesConstantOfAnotherType) {
    EXPECT_THAT(failureOf([&] { pipelineOf(kConstants, {{5, 1.0f}}); }), HasSubstr("constant_id 5"));
    EXPECT_THAT(failureOf([&] { pipelineOf(kConstants, {{3, 1u}}); }), HasSubstr("constant_id 3"));
}

TEST_F(GpuPipeline, ReadsTexelViewsUniformAndStorageBlocks) {
    gpu::Buffer bytes = device_.createBuffer(300);
    for (std::size_t i = 0; i < 300; ++i) bytes.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(i % 256);
    gpu::Buffer block = device_.createBuffer(20);
    block.as<float>()[4] = 2.5f;
    gpu::Buffer image = device_.createBuffer(16);
    const auto words = run(kResult + R"(
        layout(set = 0, binding = 1) uniform samplerBuffer normalised;
        layout(set = 0, binding = 2) uniform usamplerBuffer offset;
        layout(set = 0, binding = 3, scalar) uniform Block { vec3 first; float last[2]; };
        layout(set = 0, binding = 4, r32ui) uniform uimageBuffer image;
        uint texels(usamplerBuffer view) { return texelFetch(view, 4).x; }
        void main() {
            if (gl_LocalInvocationIndex != 0u) return;
            result[0] = floatBitsToUint(texelFetch(normalised, 255).x);
            result[1] = texels(offset);
            result[2] = uint(textureSize(offset));
            result[3] = floatBitsToUint(last[1]);
            imageStore(image, 2, uvec4(42u));
        })",
                           4, {},
                           {{.index = 1, .view = bytes.texelView(VK_FORMAT_R8_UNORM)},
                            {.index = 2, .view = bytes.texelView(VK_FORMAT_R8_UINT, 256, 20)},
                            {.index = 3, .buffer = block.handle()},
                            {.index = 4, .view = image.texelView(VK_FORMAT_R32_UINT)}});
    EXPECT_THAT(words,
                testing::ElementsAre(std::bit_cast<std::uint32_t>(1.0f), 4u, 20u, std::bit_cast<std::uint32_t>(2.5f)));
    EXPECT_EQ(image.as<std::uint32_t>()[2], 42u);
}

TEST_F(GpuPipeline, NeedsOnlyBindingsThatMainReaches) {
    const std::string unused =
        "layout(set = 0, binding = 9) uniform samplerBuffer unused;\n"
        "float neverCalled() { return texelFetch(unused, 0).x; }\n";
    EXPECT_EQ(run(kResult + unused + "void main() { result[0] = 5u; }", 1).at(0), 5u);
    EXPECT_THAT(failureOf([&] { run(kResult + unused + "void main() { result[0] = uint(neverCalled()); }", 1); }),
                HasSubstr("binding 9 (\"unused\")"));
}

TEST_F(GpuPipeline, RefusesResourcesItCannotBind) {
    EXPECT_THAT(failureOf([&] {
                    pipelineOf(kResult +
                               "layout(set = 0, binding = 1) uniform samplerBuffer grids[2];\n"
                               "void main() { result[0] = uint(texelFetch(grids[1], 0).x); }");
                }),
                HasSubstr("\"grids\""));
    EXPECT_THAT(
        failureOf([&] {
            pipelineOf("layout(set = 1, binding = 0) buffer Other { uint other; };\nvoid main() { other = 1u; }");
        }),
        HasSubstr("descriptor set"));
}

TEST_F(GpuPipeline, TakesPushConstantsOfTheDeclaredSizeOnly) {
    struct Arguments {
        glm::vec3 a;
        float b;
        glm::mat4x3 c;
        std::uint32_t d[3];
    };
    Arguments arguments{.a = {}, .b = 0, .c = {}, .d = {0, 0, 77}};
    arguments.c[3].z = 0.25f;
    gpu::Buffer result = device_.createBuffer(8);
    gpu::ComputePipeline pipeline = pipelineOf(kResult + R"(
        layout(push_constant, scalar) uniform Arguments { vec3 a; float b; mat4x3 c; uint d[3]; };
        void main() { result[0] = d[2]; result[1] = floatBitsToUint(c[3].z); })");
    pipeline.bind(std::array{gpu::Binding{.index = 0, .buffer = result.handle()}});
    const auto bytes = std::as_bytes(std::span(&arguments, 1));
    device_.submit([&](VkCommandBuffer commands) { pipeline.record(commands, bytes, 1); });
    EXPECT_EQ(result.as<std::uint32_t>()[0], 77u);
    EXPECT_EQ(result.as<float>()[1], 0.25f);
    EXPECT_THAT(failureOf([&] {
                    device_.submit([&](VkCommandBuffer commands) { pipeline.record(commands, bytes.first(4), 1); });
                }),
                HasSubstr("take 76 bytes"));
}

TEST_F(GpuPipeline, RefusesMoreGroupsOrBytesThanTheDeviceTakes) {
    gpu::Buffer small = device_.createBuffer(4);
    gpu::ComputePipeline pipeline = pipelineOf(
        kResult +
        "layout(set = 0, binding = 1) uniform Block { vec4 value; };\nvoid main() { result[0] = uint(value.x); }");
    gpu::Buffer uniform = device_.createBuffer(std::size_t{device_.limits().maxUniformBufferRange} + 4096);
    EXPECT_THAT(failureOf([&] {
                    pipeline.bind(std::array{gpu::Binding{.index = 0, .buffer = small.handle()},
                                             gpu::Binding{.index = 1, .buffer = uniform.handle()}});
                }),
                HasSubstr("maxUniformBufferRange"));
    const std::uint32_t groups = device_.limits().maxComputeWorkGroupCount[0];
    if (groups == ~0u) GTEST_SKIP() << "the device has no limit of groups";
    EXPECT_THAT(failureOf([&] {
                    device_.submit([&](VkCommandBuffer commands) { pipeline.record(commands, {}, groups + 1); });
                }),
                HasSubstr("workgroups exceed"));
}

/// A device of its own, which keeps its caches in a folder of the test.
class GpuPipelineCache : public testing::Test {
protected:
    test::TemporaryFolder cache_;
    test::ScopedVariable cacheHome_{"XDG_CACHE_HOME", cache_.path().string()};

    /// Opens a device, lets it build a pipeline, closes it; returns the file of its pipelines.
    fs::path openAndClose() {
        const fs::path shader = cache_.write("kernel.comp", kHeader + kResult + "void main() { result[0] = 1u; }");
        gpu::Device device({.validation = true, .onValidationMessage = [this](const std::string& message) {
                                messages_.push_back(message);
                            }});
        gpu::ComputePipeline pipeline(device, shader);
        return device.internals().pipelineCachePath;
    }

    std::vector<std::string> messages_;
};

TEST_F(GpuPipelineCache, IsKeptForTheNextDevice) {
    const fs::path file = openAndClose();
    const std::vector<std::byte> stored = gpu::readCacheFile(file);
    ASSERT_GE(stored.size(), sizeof(VkPipelineCacheHeaderVersionOne));
    const auto writtenAt = fs::last_write_time(file);
    EXPECT_EQ(openAndClose(), file);
    EXPECT_EQ(fs::last_write_time(file), writtenAt) << "a second run had nothing to add";
    EXPECT_EQ(messages_, std::vector<std::string>());
}

TEST_F(GpuPipelineCache, IsReplacedWhenDamagedOrForeign) {
    const fs::path file = openAndClose();
    const std::vector<std::byte> sound = gpu::readCacheFile(file);
    fs::resize_file(file, fs::file_size(file) - 1);
    openAndClose();
    EXPECT_EQ(gpu::readCacheFile(file), sound);

    std::vector<std::byte> foreign = sound;
    foreign.at(8) ^= std::byte{1};  // the vendor in VkPipelineCacheHeaderVersionOne
    gpu::writeCacheFile(file, foreign);
    openAndClose();
    EXPECT_EQ(gpu::readCacheFile(file), sound);
    EXPECT_EQ(messages_, std::vector<std::string>());
}

}  // namespace
}  // namespace parhelion
