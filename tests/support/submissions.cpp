#include "support/submissions.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "render/renderer.h"
#include "support/gpu_fixture.h"
#include "support/process_memory.h"
#include "support/render_scene.h"

namespace parhelion::test {

void expectNoNewCode(const std::string& name, const CompiledScene& scene, const EffectSet& effects) {
    constexpr int kWarmUp = 3, kSubmissions = 40;
    RenderSettings settings = settingsFor(scene, 1 << 30);
    settings.effects = effects;
    render::Renderer renderer(testDevice(), scene, settings);
    for (int i = 0; i < kWarmUp; ++i) ASSERT_TRUE(renderer.step()) << name;
    const ProcessMemory before = memoryOf(::getpid());
    for (int i = 0; i < kSubmissions; ++i) ASSERT_TRUE(renderer.step()) << name;
    const ProcessMemory after = memoryOf(::getpid());
    EXPECT_EQ(after.executableKiB, before.executableKiB) << name;
    EXPECT_LE(after.residentKiB, before.residentKiB + 2048) << name;
}

}  // namespace parhelion::test
