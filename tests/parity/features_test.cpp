// shaders/integrator/features.glsl against double precision.
#include "reference/integrator/features.h"

#include <gtest/gtest.h>

#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"

namespace parhelion {
namespace {

using test::Parity;

// A wall behind a null sphere, and a ball beside it: boundaries are passed through, the first opaque surface counts.
TEST(FeaturesParity, FirstOpaqueSurfaceAgrees) {
    constexpr glm::uvec2 kSize(64, 48);
    test::HandScene built;
    built.lookAt({0, 0, -1}, kSize);
    const std::uint32_t wall = built.addDiffuse({0.2f, 0.4f, 0.6f}), ball = built.addDiffuse({0.9f, 0.8f, 0.7f});
    const std::uint32_t cloud = built.addNull(built.addHomogeneous(1, glm::vec3(1)));
    built.addQuad({-2, -2, -5}, {4, 0, 0}, {0, 4, 0.5f}, wall);
    built.addSphere({1, 0.5f, -3}, 0.6f, ball);
    built.addSphere({-0.5f, 0, -3}, 0.8f, cloud);
    for (std::size_t i = 0; i < built.scene.shapes.size(); ++i) built.scene.constants.shapes[i] = built.scene.shapes[i];
    const reference::SceneView<double> view(built.scene);
    std::vector<glm::vec4> inputs;
    for (std::uint32_t i = 0; i < kSize.x * kSize.y; ++i) inputs.emplace_back(i % kSize.x, i / kSize.x, kSize.x, i % 7);
    const auto outputs = test::SceneProbe(built.scene).run("parity/features.comp", 0, inputs, 1, 2);
    // Camera direction 21 and the intersection 16, over the cosine under which the ball is met.
    Parity parity("integrator/features", "addFeature", 21 + 16);
    int different = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        shared::FeaturePixel expected{};
        reference::addFeature(view, 5, glm::uvec2(inputs[i]), std::uint64_t(inputs[i].w), expected);
        const bool isSame = outputs[2 * i + 1].w == expected.hits && glm::vec3(outputs[2 * i]) == expected.albedo;
        different += !isSame;
        if (!isSame) continue;
        const glm::dvec3 normal(expected.normal);
        const double facing = std::max(0.01, std::abs(normal.z));
        EXPECT_TRUE(parity.near(outputs[2 * i].w, expected.depth, 6 / (facing * facing))) << i;
        EXPECT_TRUE(parity.near(outputs[2 * i + 1], normal, 6 / (facing * facing))) << i;
    }
    EXPECT_LE(different, 2);  // at a silhouette within rounding
}

}  // namespace
}  // namespace parhelion
