#include <gtest/gtest.h>

#include "support/effect_scenes.h"
#include "support/exact_pruning.h"
#include "support/render_scene.h"

// The slow part of tests/render/effects_test.cpp.
namespace parhelion::test {
namespace {

constexpr glm::uvec2 kSize{40, 32};

TEST(EveryEffect, PruningIsExactForEverySceneFile) {
    ASSERT_FALSE(sceneFiles().empty());
    for (const auto& file : sceneFiles()) expectExactPruning(file.filename(), compileFile(file, kSize));
}

TEST(EveryEffect, PruningIsExactForEveryEffect) {
    const TemporaryFolder folder;
    EffectSet seen;
    for (const NamedScene& named : effectScenes(folder, kSize)) {
        expectExactPruning(named.name, named.scene);
        seen.on |= named.scene.effects.on;
    }
    EXPECT_EQ(seen.on, EffectSet::all().on);  // each effect is called for by some scene
}

}  // namespace
}  // namespace parhelion::test
