#include <gtest/gtest.h>
#include <unistd.h>

#include "render/bake_cloud.h"
#include "render/path_trace_pass.h"
#include "render/specialise.h"
#include "support/gpu_fixture.h"
#include "support/process_memory.h"
#include "support/render_scene.h"
#include "support/submissions.h"

// A submission compiles nothing: a night's render takes the memory of a minute's. Tiny films, of one workgroup, and
// many submissions, each of which would keep 80 KiB of code where the driver compiles anew
// (support/uniform_branches.h).
namespace parhelion::test {
namespace {

constexpr glm::uvec2 kTiny{8, 8};
constexpr long kPipelineKiB = 512;  ///< code of one pipeline, generously

TEST(SubmissionMemory, IsFlatWithAllEffectsOrNone) {
    const CompiledScene scene = compileText(sceneXml("<emitter type=\"constant\"/>"), kTiny);
    expectNoNewCode("none", scene, scene.effects);
    expectNoNewCode("all", scene, EffectSet::all());
}

TEST(SubmissionMemory, IsFlatForASingleLightMediumAndShape) {
    const CompiledScene scene = compileText(sceneXml(R"(
<shape type="sphere"><bsdf type="null"/><medium name="interior" type="homogeneous"/></shape>
<shape type="rectangle"><emitter type="area"/></shape>)"),
                                            kTiny);
    expectNoNewCode("fog and a light", scene, scene.effects);
}

TEST(SubmissionMemory, IsFlatForFeatures) {
    const CompiledScene scene = compileFile(sceneFolder() / "cornell_cloud.xml", kTiny);
    const render::DeviceScene deviceScene(testDevice(), scene);
    const RenderSettings settings = settingsFor(scene, 1);
    const gpu::Specialisation constants = render::specialise(scene, settings.effects, settings.quality);
    const auto featuresOf = [&](std::uint32_t samples) {
        render::renderFeatures(testDevice(), scene, deviceScene, settings.seed, samples, constants);
        return memoryOf(::getpid()).executableKiB;
    };
    // Each call has a pipeline of its own, which the driver frees in its own time: the last one's code (52 KiB) may
    // still be there. 78 submissions that each compile anew would keep 4 MiB.
    const long few = featuresOf(2);
    EXPECT_LE(featuresOf(80), few + kPipelineKiB);
}

TEST(SubmissionMemory, IsFlatForTheBakingOfClouds) {
    // Three slabs of 2^17 voxels, then 192.
    const auto bake = [](glm::uvec3 resolution) {
        const shared::CloudField field{.detailAmount = 0.5f,
                                       .noiseScale = 4,
                                       .warpAmount = 0.1f,
                                       .erosionAmount = 0.2f,
                                       .surfaceWidth = 0.1f,
                                       .densityScale = 1,
                                       .densityThreshold = 0,
                                       .noiseSeed = 1,
                                       .resolution = resolution,
                                       .modulates = 0};
        render::bakeCloud(testDevice(), field, {}, 0);
        return memoryOf(::getpid()).executableKiB;
    };
    const long few = bake({64, 64, 96});
    EXPECT_LE(bake({64, 64, 64 * 96}), few + kPipelineKiB);
}

}  // namespace
}  // namespace parhelion::test
