// shaders/integrator/direct_lighting.glsl against double precision.
#include "reference/integrator/direct_lighting.h"

#include <gtest/gtest.h>

#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/stress.h"
#include "support/words.h"

namespace parhelion {
namespace {

using test::Parity;
using test::Stress;

const char* const kShader = "parity/direct_lighting.comp";
enum Function : std::uint32_t { kScatter, kDrift, kDirect };

/// A scatterer as the shader takes it, in two rows.
struct Scatterer {
    glm::vec3 axis, wo;
    float g = 0;
    bool isSurface = false;

    void addTo(std::vector<glm::vec4>& inputs) const {
        inputs.emplace_back(axis, g);
        inputs.emplace_back(wo, isSurface);
    }
};

reference::Medium<double> mediumOf(const Scatterer& scatterer) {
    reference::Medium<double> medium{};
    medium.g = scatterer.g;
    medium.phase = scatterer.g == 0 ? shared::kPhaseIsotropic : shared::kPhaseHenyeyGreenstein;
    return medium;
}

reference::Vertex<double> vertexOf(const Scatterer& scatterer, const reference::Medium<double>& medium) {
    reference::Vertex<double> vertex;
    vertex.wo = scatterer.wo;
    vertex.medium = scatterer.isSurface ? nullptr : &medium;
    vertex.surface.shadingNormal = vertex.surface.geometricNormal = scatterer.axis;
    return vertex;
}

std::vector<Scatterer> scatterers() {
    std::vector<Scatterer> all;
    Stress stress(31);
    for (const glm::vec3& axis : test::stressDirections(1'000)) {
        all.push_back({axis, stress.direction(), 0, true});
        all.push_back({{0, 0, 1}, stress.direction(), 0, false});
        for (const float g : {1e-6f, -0.3f, 0.85f, 0.999f}) all.push_back({axis, -axis, g, false});
    }
    return all;
}

TEST(DirectLightingParity, ScatteringValueAndSampleAgree) {
    std::vector<glm::vec4> inputs;
    Stress stress(32);
    const auto uniforms = test::stressUniforms();
    const auto all = scatterers();
    for (const Scatterer& scatterer : all) {
        scatterer.addTo(inputs);
        inputs.emplace_back(stress.direction(), 0);
        const std::uint32_t word = test::wordOf(uniforms[stress.word() % uniforms.size()]);
        inputs.emplace_back(glm::uintBitsToFloat(glm::uvec2(word, stress.word())), 0, 0);
    }
    const auto outputs = test::SceneProbe(test::HandScene().scene).run(kShader, kScatter, inputs, 4, 2);
    Parity value("integrator/direct_lighting", "evalScatterer", 30);  // of evalHenyeyGreenstein
    // Deflection 17 and warp 10, basis 9, product and sum 2, in three components, then the normalisation 9.
    Parity direction("integrator/direct_lighting", "sampleScatterer", 3 * (17 + 10 + 9 + 2) + 9);
    Parity density("integrator/direct_lighting", "sampleScatterer", 17);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto medium = mediumOf(all[i]);
        const auto vertex = vertexOf(all[i], medium);
        const double expected = reference::evalScatterer(vertex, glm::dvec3(inputs[4 * i + 2]));
        EXPECT_TRUE(value.near(outputs[2 * i].x, expected, all[i].isSurface ? 1 : expected)) << i;
        auto sample = reference::sampleScatterer(vertex, glm::floatBitsToUint(glm::vec2(inputs[4 * i + 3])));
        EXPECT_TRUE(direction.near(outputs[2 * i + 1], sample.direction)) << i;
        EXPECT_TRUE(density.near(outputs[2 * i + 1].w, sample.pdf, std::max(sample.pdf, 0.1))) << i;
    }
}

// H11: the direction stays unit through ten thousand scatterings; rotated without normalisation it drifts.
TEST(DirectLightingParity, DirectionsStayUnitThroughManyScatteringsH11) {
    constexpr double kUnit = 2e-7;
    std::vector<glm::vec4> inputs;
    glm::vec3 drifting(0, 0, 1);
    for (const float g : {-0.9f, -0.3f, 0.3f, 0.85f, 0.99f, 0.999f}) Scatterer{{0, 0, 1}, {0, 0, -1}, g}.addTo(inputs);
    const auto outputs = test::SceneProbe(test::HandScene().scene).run(kShader, kDrift, inputs, 2, 1);
    Parity parity("integrator/direct_lighting", "sampleScatterer", kUnit / test::kRounding);
    for (const glm::vec4& output : outputs) EXPECT_TRUE(parity.near(glm::length(glm::dvec3(output)), 1, 1));
    Stress stress(33);
    for (int i = 0; i < 10'000; ++i) {
        const auto deflection = reference::sampleHenyeyGreenstein(0.999f, stress.between(0, 1));
        const glm::vec2 turn = deflection.sinTheta * reference::sinCosTurn(stress.between(0, 1));
        const glm::vec3 local(turn.y, turn.x, deflection.mu);
        drifting = reference::toWorld(reference::frameFromNormal(drifting), local);
    }
    EXPECT_GT(std::abs(glm::length(glm::dvec3(drifting)) - 1), kUnit);
}

/// A quad light and a point light.
test::HandScene litScene() {
    test::HandScene built;
    const std::uint32_t shape = built.addDiffuse(glm::vec3(0.5f));
    built.addAreaLight(shared::kLightQuad, built.addQuad({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}, shape), shape, {5, 4, 3});
    shared::Light point{};
    point.type = shared::kLightPoint;
    point.vector = {0.5f, 2, 3};
    point.emission = {1, 2, 3};
    built.addLight(point);
    return built;
}

// Contribution, threshold and the way of the shadow ray.
TEST(DirectLightingParity, EstimateAgreesOnSurfacesAndInMedia) {
    const test::HandScene built = litScene();
    const reference::SceneView<double> view(built.scene);
    std::vector<glm::vec4> inputs;
    Stress stress(34);
    const auto all = scatterers();
    for (const Scatterer& scatterer : all) {
        scatterer.addTo(inputs);
        inputs.emplace_back(stress.point(1), scatterer.isSurface ? 0.7f : 1.0f);
        inputs.emplace_back(glm::uintBitsToFloat(glm::uvec3(stress.word(), stress.word(), stress.word())), 0);
    }
    const auto outputs = test::SceneProbe(built.scene).run(kShader, kDirect, inputs, 4, 2);
    // Light sample 2 * 72, value 30, weight 11, two products; a direction's 72 turn a lobe's value by a / (1 - a).
    Parity parity("integrator/direct_lighting", "estimateDirect", 2 * 72 + 30 + 11 + 2);
    const Quality quality;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto light = reference::sampleLight(view, glm::dvec3(inputs[4 * i + 2]),
                                                  glm::floatBitsToUint(glm::vec3(inputs[4 * i + 3])));
        ASSERT_TRUE(light) << i;
        const auto medium = mediumOf(all[i]);
        const double value = reference::evalScatterer(vertexOf(all[i], medium), light->direction);
        const double weight = light->isDelta ? 1 : reference::balanceHeuristic(light->pdf, value);
        const double a = std::abs(double(all[i].g)), lobe = 1 + 3 * a / (1 - a);
        // A cosine next to 0 keeps an absolute error; so does the light's own.
        const double scale = lobe * (all[i].isSurface ? std::max(value, 0.3) : value) * 10;
        for (int c = 0; c < 3; ++c)
            EXPECT_TRUE(parity.near(outputs[2 * i][c], light->radianceOverPdf[c] * weight * value,
                                    light->radianceOverPdf[c] * scale))
                << i;
        const double bright = 4 * reference::kPi<double> * value * inputs[4 * i + 2].w;
        if (value > 1e-3) {
            EXPECT_NEAR(outputs[2 * i].w, std::min(1.0, quality.shadowRoulette / bright), 1e-3 * lobe) << i;
        }
        EXPECT_TRUE(parity.near(outputs[2 * i + 1], light->direction, 4)) << i;
    }
}

}  // namespace
}  // namespace parhelion
