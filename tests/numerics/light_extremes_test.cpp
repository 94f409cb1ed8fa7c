#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/light/light.h"
#include "reference/reference_renderer.h"
#include "support/goodness.h"
#include "support/hand_scene.h"
#include "unit/compile_fixtures.h"

// Lights at their extremes, on the float reference.
namespace parhelion {
namespace {

using test::HandScene;
using test::PixelEstimate;

TEST(BlackLights, AreDroppedAndLeaveDarkness) {  // H55
    SceneDescription description = fixtures::scene();
    description.shapes = {fixtures::rectangle("wall"),
                          fixtures::emissive(fixtures::sphere("lamp", {0, 0, 3}, 1), {0, 0, 0})};
    EmitterDescription sky;
    sky.value = glm::dvec3(0);
    description.emitters = {sky};
    const CompiledScene compiled = compileScene(description);
    EXPECT_EQ(compiled.constants.lightCount, 0u);
    EXPECT_EQ(compiled.constants.environment, shared::kNone);
    EXPECT_FALSE(compiled.notes.empty());
    RenderSettings settings;
    settings.sampleCount = 4;
    const Film film = reference::render<float>(compiled, settings);
    for (const shared::FilmPixel& pixel : film.pixels) ASSERT_EQ(pixel.sumHigh, glm::vec3(0));
    EXPECT_EQ(film.counters[shared::kCounterNonFinite], 0u);
}

HandScene fogUnderSun(float irradiance) {
    HandScene scene = test::fogBox({0.9f, 0.7f, 0.5f});
    shared::Light sun{};
    sun.type = shared::kLightDirectional;
    sun.emission = irradiance * glm::vec3(1, 0.8f, 0.6f);
    sun.vector = glm::normalize(glm::vec3(0.3f, 1, 0.2f));
    scene.addLight(sun);
    return scene;
}

TEST(DirectionalLight, HalvesToTheBit) {  // H63; H71: and so for every power of two
    RenderSettings settings;
    settings.sampleCount = 256;
    const auto sum = [&](float irradiance) {
        return reference::render<float>(fogUnderSun(irradiance).scene, settings).pixels[0].sumHigh;
    };
    const glm::vec3 unit = sum(1);
    EXPECT_GT(unit.x, 0);
    for (const int exponent : {-33, -1, 1, 33}) {
        const float factor = std::ldexp(1.0f, exponent);
        EXPECT_EQ(sum(factor), factor * unit) << exponent;
    }
}

TEST(TinyTriangleLight, ShinesLikeAPoint) {  // H64: 1e-6 units wide, 1.5 above the floor
    const float size = 1e-6f, radiance = 1e12f;
    HandScene scene = test::floorPatch();
    const glm::vec3 a{0, 0, 0.5f};
    scene.addTriangles(std::vector<glm::vec3>{a, a + glm::vec3(0, size, 0), a + glm::vec3(size, 0, 0)},
                       scene.addDiffuse(glm::vec3(0)));
    scene.addMeshLight(1, glm::vec3(radiance));
    // Area A facing the floor at distance h: irradiance L A / h^2, exitant over pi.
    const double exact = 0.5 / std::acos(-1.0) * double(radiance) * 0.5 * double(size) * double(size) / (1.5 * 1.5);
    const PixelEstimate found = test::renderPixel(scene.scene, 256);
    EXPECT_NEAR(found.mean / exact, 1, 1e-3);
    // Scattering alone never finds it: the naive estimator is 0.
    scene.scene.constants.lights[0].selection = scene.scene.constants.lights[0].cumulative = 0;
    EXPECT_EQ(test::renderPixel(scene.scene, 256).mean, 0);
}

TEST(PointsAtALight, StayBelowTheBoundOfTheBalanceHeuristic) {  // H65: fog that touches a lamp
    HandScene scene;
    scene.lookAlong({0, 0, -1});
    const std::uint32_t lamp = scene.addDiffuse(glm::vec3(0));
    const std::uint32_t quad = scene.addQuad({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, lamp);
    scene.addBox({-1, -1, -2}, {1, 1, -1.9f}, scene.addNull(scene.addHomogeneous(30, glm::vec3(1))));
    scene.addAreaLight(shared::kLightQuad, quad, lamp, glm::vec3(1));
    scene.scene.constants.maxDepth = 2;
    RenderSettings settings;
    float largest = 0, naive = 0;
    const reference::SceneView<float> view(scene.scene);
    test::IndependentNumbers numbers(1);
    for (std::uint64_t s = 0; s < 300'000; ++s) {
        const glm::vec3 radiance = reference::tracePath<float>(scene.scene, settings, {0, 0}, s);
        ASSERT_TRUE(std::isfinite(radiance.x));
        largest = std::max(largest, radiance.x);
        // Light sampling alone at the same depth of fog: Le f / pdf.
        const glm::vec3 point(0, 0, -2 + 0.1f * numbers.uniform<float>());
        const auto sample = reference::sampleLight(view, point, glm::vec3(0, numbers.pair<float>()));
        if (sample) naive = std::max(naive, sample->radianceOverPdf.x / (4 * reference::kPi<float>));
    }
    // f / p of the isotropic phase function is 1: at most Le from each of the two techniques.
    EXPECT_LE(largest, 2.00001f);
    EXPECT_GT(largest, 0.9f);
    // By itself light sampling has no bound. Of heights h below 0.1 and points at r from the foot, 4 h / 4 pi d^3 is
    // above 100 for one in 2700: 110 of these.
    EXPECT_GT(naive, 100.0f);
}

TEST(PointLight, AtTheVertexItselfSendsNothing) {  // H43
    HandScene scene;
    shared::Light bulb{};
    bulb.type = shared::kLightPoint;
    bulb.emission = glm::vec3(1);
    bulb.vector = {1, 2, 3};
    scene.addLight(bulb);
    const reference::SceneView<float> view(scene.scene);
    EXPECT_FALSE(reference::sampleLight(view, bulb.vector, glm::vec3(0.5f)));
    EXPECT_TRUE(std::isnan(glm::normalize(glm::vec3(0)).x)) << "the naive direction";
}

}  // namespace
}  // namespace parhelion
