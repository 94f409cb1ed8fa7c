#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compile/compile_scene.h"
#include "reference/light/light.h"
#include "reference/reference_renderer.h"
#include "support/goodness.h"
#include "support/hand_scene.h"
#include "support/words.h"
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
        const auto sample = reference::sampleLight(view, point, test::lightWords(numbers.pair<float>()));
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
    EXPECT_FALSE(reference::sampleLight(view, bulb.vector, glm::uvec3(0x80000000u)));
    EXPECT_TRUE(std::isnan(glm::normalize(glm::vec3(0)).x)) << "the naive direction";
}

// H7, H44: 256 lights leave 2^15 of the 2^24 numbers that chose between them to a mesh of 81920 triangles. Each
// triangle has a word in the middle of its own that finds it, as often as the density says.
TEST(LightExtremes, EveryTriangleOfAMeshAmongManyLightsIsFound) {
    SceneDescription description = fixtures::scene();
    description.shapes = {fixtures::emissive(fixtures::soup("ball", test::icosphere(6)), {1e-3, 1e-3, 1e-3})};
    EmitterDescription bulb;
    bulb.type = EmitterDescription::Type::Point;
    bulb.value = glm::dvec3(1000);
    description.emitters.assign(shared::kMaxLights - 1, bulb);
    const CompiledScene compiled = compileScene(description);
    const reference::SceneView<double> view(compiled);
    const reference::Light<double>& mesh = view.lights[0];
    ASSERT_EQ(mesh.triangleCount, 81'920u);
    EXPECT_LT(mesh.selection * 0x1p24, mesh.triangleCount) << "one number of 24 bits would not do";
    const auto width = std::uint64_t(mesh.selection * 0x1p32);
    const glm::uvec2* table = &compiled.distributions[mesh.distribution];
    for (std::uint32_t i = 0; i < mesh.triangleCount; ++i) {
        const std::uint32_t words = table[i + 1].x - table[i].x;
        const std::uint64_t pair = (table[i].x + words / 2) * width;  // of x and z, that zoom in on the middle word
        const glm::uvec3 draw(std::uint32_t(pair >> 32), 1u << 30, std::uint32_t(pair));
        const std::uint32_t primitive = compiled.lightTriangles[mesh.triangleOffset + i];
        const glm::dvec3 outside = 3.0 * reference::triangleSurface(view, primitive, glm::dvec2(0.3)).position -
                                   2.0 * -glm::dvec3(compiled.worldOrigin);
        const auto sample = reference::sampleLight(view, outside, draw);
        ASSERT_TRUE(sample) << i;
        ASSERT_EQ(sample->target, primitive) << i;
        const glm::dvec3 normal = reference::flatNormal(view, primitive);
        const double cosine = std::abs(glm::dot(normal, sample->direction));
        const double perArea = sample->pdf * cosine / (sample->distance * sample->distance);
        const glm::dvec3 a = view.vertex(primitive, 0), b = view.vertex(primitive, 1), c = view.vertex(primitive, 2);
        const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
        ASSERT_NEAR(perArea * area / (mesh.selection * words * 0x1p-32), 1, 1e-6) << i;
        const double met = reference::lightPdf(view, mesh, primitive, outside, sample->direction, sample->distance,
                                               reference::lightCosine(mesh, normal, normal, -sample->direction));
        ASSERT_NEAR(met / sample->pdf, 1, 1e-9) << i;
    }
}

}  // namespace
}  // namespace parhelion
