#include <gtest/gtest.h>

#include "support/effect_scenes.h"
#include "support/exact_pruning.h"
#include "support/render_scene.h"

// Pruning is exact: compiled for its own effects or for all of them, a scene's film is the same to the bit. What would
// break it: an effect that the analysis misses, a module that acts on an effect the scene has not, and a driver that
// rounds the same expression differently when its surroundings differ.
// tests/nightly/every_effect_test.cpp takes every scene; compiling both variants of each takes a minute.
namespace parhelion::test {
namespace {

constexpr glm::uvec2 kSize{40, 32};

TEST(Effects, PruningIsExact) {
    const TemporaryFolder folder;
    expectExactPruning("cloud_box.xml", compileFile(sceneFolder() / "cloud_box.xml", kSize));
    for (const NamedScene& named : effectScenes(folder, kSize))
        if (named.name.starts_with("several media") || named.name.starts_with("textured"))
            expectExactPruning(named.name, named.scene);
}

// The test sees what it is for: an effect that the analysis had missed.
TEST(Effects, AMissedEffectShows) {
    const TemporaryFolder folder;
    CompiledScene scene = effectScenes(folder, kSize).at(3).scene;
    ASSERT_TRUE(scene.effects.has(Effect::hasAlbedoGrids));
    const Film right = renderWithEffects(scene, scene.effects);
    for (const Effect missed : {Effect::hasAlbedoGrids, Effect::hasAreaLights, Effect::hasSpheres}) {
        EffectSet fewer = scene.effects;
        fewer.on.reset(unsigned(missed));
        EXPECT_GT(countDifferentPixels(right, renderWithEffects(scene, fewer)), 0u) << unsigned(missed);
    }
}

}  // namespace
}  // namespace parhelion::test
