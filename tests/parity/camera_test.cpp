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

/// A film of 4000 x 3000 pixels with the given table of its filter; empty: box.
test::HandScene filmScene(std::vector<float> table) {
    test::HandScene built;
    built.lookAt({0.3f, -0.5f, -1}, {4000, 3000});
    shared::Camera& camera = built.scene.constants.camera;
    camera.hasFilter = table.empty() ? 0 : 1;
    camera.filterEdges = table.empty() ? 0 : std::uint32_t(table.size()) - shared::kFilterSteps - 1;
    camera.filmLower = {0, 0};
    camera.filmUpper = {4000, 3000};
    built.scene.filterTable = std::move(table);
    return built;
}

/// Pixels anywhere and, every other time, within four of a corner.
std::vector<glm::vec4> samples() {
    std::vector<glm::vec4> inputs;
    Stress stress(22);
    bool near = false;
    for (const float u : test::stressUniforms(3'000)) {
        const std::uint32_t x = stress.word() % 4000, y = stress.word() % 3000;
        const glm::uvec2 corner(x % 2 ? x / 2 % 4 : 3999 - x / 2 % 4, y % 2 ? y / 2 % 4 : 2999 - y / 2 % 4);
        near = !near;
        inputs.emplace_back(near ? glm::vec2(corner) : glm::vec2(x, y), u, stress.between(0, 1));
    }
    return inputs;
}

void expectSameRays(const test::HandScene& built) {
    const reference::SceneView<double> view(built.scene);
    const auto inputs = samples();
    const auto outputs = test::SceneProbe(built.scene).run("parity/camera.comp", 0, inputs, 1, 2);
    // Two sums on a film up to 4096 wide, and the offset.
    Parity film("integrator/camera", "filmPosition", 3);
    // Two products and sums of vectors up to 3 long, then the normalisation (9).
    Parity direction("integrator/camera", "cameraDirection", 4 * 3 + 9);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::dvec2 pixel(inputs[i]), u(inputs[i].z, inputs[i].w);
        const glm::dvec2 expected = reference::filmPosition(view, glm::uvec2(pixel), u);
        EXPECT_TRUE(film.near(outputs[2 * i].x, expected.x, 4096)) << u.x;
        EXPECT_TRUE(film.near(outputs[2 * i].y, expected.y, 4096)) << u.y;
        // The film position as the device rounds it: pixel + u.
        const glm::vec2 rounded = glm::vec2(inputs[i]) + glm::vec2(inputs[i].z, inputs[i].w);
        EXPECT_TRUE(direction.near(outputs[2 * i + 1], reference::cameraDirection(view, glm::dvec2(rounded)))) << i;
    }
}

void expectSameFilter(const test::HandScene& built) {
    const reference::SceneView<double> view(built.scene);
    const std::span<const float> table(built.scene.filterTable);
    const auto inputs = samples();
    const auto outputs = test::SceneProbe(built.scene).run("parity/camera.comp", 0, inputs, 1, 2);
    // A table entry, a difference, a product, a sum, of offsets up to the radius.
    Parity offset("integrator/camera", "filterOffset", 4), share("integrator/camera", "filterShare", 0);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        EXPECT_TRUE(offset.near(outputs[2 * i].z, reference::filterOffset(table, double(inputs[i].z)), 2)) << i;
        EXPECT_TRUE(share.near(outputs[2 * i].w, reference::filterShare(view, std::uint32_t(inputs[i].x)))) << i;
        // At its edges the film ends, to within 2^-24 of 4000 pixels.
        EXPECT_GE(outputs[2 * i].x, -3e-4f);
        EXPECT_LE(outputs[2 * i].x, 4000 + 3e-4f);
    }
}

// H72: u = 0 and the largest u below 1, where an interpolated table would be left.
TEST(CameraParity, FilmPositionsAndDirectionsAgreeH72) {
    expectSameRays(filmScene({}));
    std::vector<float> table;
    for (int i = 0; i <= 256; ++i) table.push_back(2 * std::sin(1.5707963f * (float(i) / 128 - 1)));
    // u = 1/2 + asin(x / 2) / pi at x = 1/2 and 3/2; the table is linear between its steps, which the edge's last
    // entry meets to 2^-16.
    for (const float x : {0.5f, 1.5f}) table.push_back(0.5f + std::asin(x / 2) / 3.1415927f);
    const test::HandScene ends = filmScene(table);
    expectSameRays(ends);
    expectSameFilter(ends);
    table.resize(257);
    test::HandScene reaches = filmScene(table);
    const reference::SceneView<double> view(reaches.scene), cut(ends.scene);
    EXPECT_LT(reference::filmPosition(view, {0, 0}, glm::dvec2(0.01)).x, -1) << "beyond the film";
    EXPECT_GE(reference::filmPosition(cut, {0, 0}, glm::dvec2(0.01)).x, -1e-4);
}

}  // namespace
}  // namespace parhelion
