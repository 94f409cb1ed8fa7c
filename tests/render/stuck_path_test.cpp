#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "render/renderer.h"
#include "support/gpu_fixture.h"
#include "support/hand_scene.h"
#include "support/render_scene.h"

// A path that stays at one point of a ray for ever ends the render with an error that names it; one that is merely long
// does not.
namespace parhelion::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A box of a medium whose density is `density` everywhere although its majorants say 1, seen from outside.
HandScene thinGrid(float sigma, float density) {
    HandScene hand;
    hand.lookAlong({0, 0, -1});
    const glm::vec3 low(-1, -1, -4), high(1, 1, -2);
    const std::vector<float> voxels(64, 1.0f);
    const std::uint32_t medium = hand.addGrid(sigma, glm::vec3(1), {4, 4, 4}, voxels, low, high);
    hand.addBox(low, high, hand.addNull(medium));
    hand.setEnvironment(glm::vec3(1));
    std::ranges::fill(hand.scene.density, density);
    std::ranges::copy(hand.scene.shapes, hand.scene.constants.shapes);  // what compileScene does for the device
    return hand;
}

std::string failureOf(const CompiledScene& scene) {
    RenderSettings settings = settingsFor(scene, 2);
    settings.effects = EffectSet::all();
    settings.effects.on[static_cast<unsigned>(Effect::hasBrickedDensity)] = false;
    settings.firstSample = 5;
    try {
        render::render(testDevice(), scene, settings);
    } catch (const RuntimeFailure& failure) {
        return failure.what();
    }
    return "rendered";
}

// 1 / sigma is below every step of t: null collisions take the path nowhere.
TEST(StuckPath, IsNoticedInCollisionsWithoutEnd) {
    EXPECT_THAT(failureOf(thinGrid(1e30f, 0).scene),
                AllOf(HasSubstr("make no progress"), HasSubstr("sample 5 of pixel (0, 0)"), HasSubstr("report")));
}

// The ray that is stuck is a shadow ray or a later flight, from a floor in front of the camera into a medium behind it.
TEST(StuckPath, IsNoticedBehindASurface) {
    HandScene hand = floorPatch();
    const glm::vec3 low(-50, -50, 1), high(50, 50, 3);
    const std::uint32_t medium = hand.addGrid(1e30f, glm::vec3(1), {4, 4, 4}, std::vector<float>(64, 1.0f), low, high);
    hand.addBox(low, high, hand.addNull(medium));
    hand.setEnvironment(glm::vec3(1));
    std::ranges::fill(hand.scene.density, 0.0f);
    std::ranges::copy(hand.scene.shapes, hand.scene.constants.shapes);
    EXPECT_THAT(failureOf(hand.scene), HasSubstr("make no progress"));
}

// Four hundred thousand null collisions on a ray of one pixel, each a step ahead: far more than the turns at one point
// that are allowed.
TEST(StuckPath, IsNoneThatIsMerelyLong) { EXPECT_EQ(failureOf(thinGrid(2e5f, 0).scene), "rendered"); }

}  // namespace
}  // namespace parhelion::test
