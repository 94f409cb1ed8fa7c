// shaders/integrator/camera.glsl against double precision.
#include "reference/integrator/camera.h"

#include <gtest/gtest.h>

#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::Parity;
using test::Stress;

/// A film of 4000 x 3000 pixels with the given inverse CDF of its filter; empty: box.
test::HandScene filmScene(std::vector<float> table, float radius) {
    test::HandScene built;
    built.lookAt({0.3f, -0.5f, -1}, {4000, 3000});
    built.scene.constants.camera.filterRadius = radius;
    built.scene.filterTable = std::move(table);
    return built;
}

std::vector<glm::vec4> samples() {
    std::vector<glm::vec4> inputs;
    Stress stress(22);
    for (const float u : test::stressUniforms(3'000))
        inputs.emplace_back(stress.word() % 4000, stress.word() % 3000, u, stress.between(0, 1));
    return inputs;
}

void expectSameRays(const test::HandScene& built) {
    const reference::SceneView<double> view(built.scene);
    const bool isBox = built.scene.filterTable.empty();
    const auto inputs = samples();
    const auto outputs = test::SceneProbe(built.scene).run("parity/camera.comp", 0, inputs, 1, 2);
    // A table entry, a difference, a product, a sum, of offsets up to the radius.
    Parity offset("integrator/camera", "filterOffset", 4);
    // Two sums on a film up to 4096 wide, and the offset.
    Parity film("integrator/camera", "filmPosition", 3);
    // Two products and sums of vectors up to 3 long, then the normalisation (9).
    Parity direction("integrator/camera", "cameraDirection", 4 * 3 + 9);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::dvec2 pixel(inputs[i]), u(inputs[i].z, inputs[i].w);
        const glm::dvec2 expected = reference::filmPosition(view, glm::uvec2(pixel), u);
        EXPECT_TRUE(film.near(outputs[2 * i].x, expected.x, 4096)) << u.x;
        EXPECT_TRUE(film.near(outputs[2 * i].y, expected.y, 4096)) << u.y;
        if (!isBox) {
            const std::span<const float> table(built.scene.filterTable);
            EXPECT_TRUE(offset.near(outputs[2 * i].z, reference::filterOffset(table, u.x) - 0.5, 2)) << u.x;
        }
        // The film position as the device rounds it: pixel + u.
        const glm::vec2 rounded = glm::vec2(inputs[i]) + glm::vec2(inputs[i].z, inputs[i].w);
        EXPECT_TRUE(direction.near(outputs[2 * i + 1], reference::cameraDirection(view, glm::dvec2(rounded)))) << i;
    }
}

// H72: u = 0 and the largest u below 1, where an interpolated table would be left.
TEST(CameraParity, FilmPositionsAndDirectionsAgreeH72) {
    expectSameRays(filmScene({}, 0.5f));
    std::vector<float> table;
    for (int i = 0; i <= 256; ++i) table.push_back(2 * std::sin(1.5707963f * (float(i) / 128 - 1)));
    expectSameRays(filmScene(table, 2.0f));
}

}  // namespace
}  // namespace parhelion
