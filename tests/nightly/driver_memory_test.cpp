#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <thread>

#include "render/specialise.h"
#include "support/effect_scenes.h"
#include "support/paths.h"
#include "support/process_memory.h"
#include "support/render_scene.h"
#include "support/run_program.h"
#include "support/scoped_variable.h"
#include "support/submissions.h"
#include "support/uniform_branches.h"

// The slow part of tests/render/submission_memory_test.cpp and tests/unit/uniform_branches_test.cpp.
namespace parhelion::test {
namespace {

constexpr glm::uvec2 kTiny{8, 8};

/// Every scene of scenes/, and those that together call for every effect.
std::vector<NamedScene> allScenes(const TemporaryFolder& folder) {
    std::vector<NamedScene> scenes = effectScenes(folder, kTiny);
    for (const auto& file : sceneFiles()) scenes.push_back({file.filename(), compileFile(file, kTiny)});
    return scenes;
}

TEST(DriverMemory, KernelsDecideNothingByUniformsAlone) {
    const TemporaryFolder folder;
    for (const NamedScene& named : allScenes(folder))
        for (const char* kernel : {"kernels/path_trace.comp", "kernels/features.comp"})
            EXPECT_THAT(uniformDecisions(gpu::compileShader(gpu::shaderFolder() / kernel),
                                         render::specialise(named.scene, named.scene.effects, {})),
                        testing::IsEmpty())
                << named.name << ", " << kernel;
}

TEST(DriverMemory, SubmissionsOfEverySceneNeedNoNewCode) {
    const TemporaryFolder folder;
    for (const NamedScene& named : allScenes(folder)) expectNoNewCode(named.name, named.scene, named.scene.effects);
}

/// Renders for a minute and expects that the last fifty seconds take no more than 2 MiB, and no code.
void expectFlatMinute(const std::string& scene) {
    const TemporaryFolder folder;
    ChildProgram program(test::programFile(),
                         {"render", (sceneFolder() / scene).string(), "-o", "out.exr", "--size", "64x64", "--spp",
                          "1000000000", "--quiet"},
                         folder.path());
    std::this_thread::sleep_for(std::chrono::seconds(10));
    const ProcessMemory before = memoryOf(program.process());
    std::this_thread::sleep_for(std::chrono::seconds(50));
    const ProcessMemory after = memoryOf(program.process());
    EXPECT_LE(after.residentKiB, before.residentKiB + 2048) << scene;
    EXPECT_EQ(after.executableKiB, before.executableKiB) << scene;
    program.signal(SIGTERM);
    EXPECT_EQ(program.wait().exitCode, 130) << scene;
}

TEST(DriverMemory, IsFlatForAMinute) {
    for (const char* scene : {"white_furnace.xml", "bunny_under_sky.xml"}) expectFlatMinute(scene);
}

TEST(DriverMemory, IsFlatForAMinuteWithoutADiskCache) {
    const ScopedVariable noCache("MESA_SHADER_CACHE_DISABLE", "true");
    expectFlatMinute("white_furnace.xml");
}

}  // namespace
}  // namespace parhelion::test
