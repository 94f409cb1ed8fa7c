#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "reference/reference_renderer.h"
#include "support/hand_scene.h"

namespace parhelion {
namespace {

using test::floorPatch;
using test::HandScene;
using test::PixelEstimate;

// |z| for a family of 1e-6 over a few dozen comparisons.
constexpr double kZ = 5.7;
constexpr double kPi = 3.14159265358979;

void expectValue(const PixelEstimate& a, double exact, const std::string& what) {
    EXPECT_LT(std::abs(a.mean - exact) / std::hypot(a.error, 2e-6 * exact, 1e-12), kZ)
        << what << ": " << a.mean << " +- " << a.error << ", exact " << exact;
}

enum class Method { Scattering, Both };

/// The unit square, 1 above the floor, that shines down; the camera is half-way between.
HandScene unitSquare(Method method, bool asMesh) {
    HandScene scene = floorPatch(glm::vec3(1), 0.5f);
    const std::uint32_t shape = scene.addDiffuse(glm::vec3(0));
    const bool isSampled = method == Method::Both;
    if (asMesh) {
        const glm::vec3 a{-0.5f, -0.5f, 0.5f}, b{-0.5f, 0.5f, 0.5f}, c{0.5f, 0.5f, 0.5f}, d{0.5f, -0.5f, 0.5f};
        scene.addTriangles(std::vector<glm::vec3>{a, b, c, a, c, d}, shape);
        scene.addMeshLight(shape, glm::vec3(3), isSampled);
    } else {
        const std::uint32_t quad = scene.addQuad({-0.5f, -0.5f, 0.5f}, {0, 1, 0}, {1, 0, 0}, shape);
        scene.addAreaLight(shared::kLightQuad, quad, shape, glm::vec3(3), isSampled);
    }
    return scene;
}

TEST(ReferenceLight, UnitSquareHasItsFormFactor) {
    for (const bool asMesh : {false, true})
        for (const Method method : {Method::Scattering, Method::Both}) {
            const std::string what = std::string(asMesh ? "mesh" : "quad") + (method == Method::Both ? " both" : "");
            expectValue(test::renderPixel(unitSquare(method, asMesh).scene, 400000), 3 * 0.2394564705, what);
            expectValue(test::renderPixel(unitSquare(method, asMesh).scene, 400000, true), 3 * 0.2394564705, what);
        }
}

/// Turns the light's front away from the floor, where one side alone would leave it dark.
HandScene turnedOver(HandScene scene, bool isTwoSided) {
    shared::SceneConstants& constants = scene.scene.constants;
    constants.quads[1].normal = -constants.quads[1].normal;
    auto& triangles = scene.scene.triangles;
    for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) std::swap(triangles[i + 1], triangles[i + 2]);
    if (isTwoSided) constants.lights[0].flags |= shared::kLightTwoSided;
    return scene;
}

TEST(ReferenceLight, TwoSidedUnitSquareHasItsFormFactorFromBehind) {
    for (const bool asMesh : {false, true})
        for (const Method method : {Method::Scattering, Method::Both}) {
            const std::string what = std::string(asMesh ? "mesh" : "quad") + (method == Method::Both ? " both" : "");
            const HandScene scene = turnedOver(unitSquare(method, asMesh), true);
            expectValue(test::renderPixel(scene.scene, 400000), 3 * 0.2394564705, what);
            expectValue(test::renderPixel(scene.scene, 400000, true), 3 * 0.2394564705, what);
            EXPECT_EQ(test::renderPixel(turnedOver(unitSquare(method, asMesh), false).scene, 1000).mean, 0.0) << what;
        }
}

TEST(ReferenceLight, TwoSidedSphereIsAFurnaceFromInside) {
    // The camera and a floor of reflectance 1/2 within a sphere of radiance 2; nothing else reflects.
    for (const Method method : {Method::Scattering, Method::Both})
        for (const bool isFlipped : {false, true}) {
            HandScene scene = floorPatch(glm::vec3(0.5f));
            const std::uint32_t shape = scene.addDiffuse(glm::vec3(0), isFlipped ? shared::kShapeFlipNormal : 0u);
            const std::uint32_t id = scene.addSphere({0, 0, 0.5f}, 3, shape);
            scene.addAreaLight(shared::kLightSphere, id, shape, glm::vec3(2), method == Method::Both);
            scene.scene.constants.lights[0].flags |= shared::kLightTwoSided;
            expectValue(test::renderPixel(scene.scene, 20000), 0.5 * 2, "on the floor");
            scene.lookAlong({0, 0, 1});
            EXPECT_EQ(test::renderPixel(scene.scene, 16).mean, 2.0);
        }
}

TEST(ReferenceLight, AbsorptionDimsTheUnitSquare) {
    // The whole space between floor and light absorbs, sigma 0.5: 0.1402340562; the way to the camera exp(-0.25).
    for (const Method method : {Method::Scattering, Method::Both}) {
        HandScene scene = unitSquare(method, false);
        const std::uint32_t fog = scene.addNull(scene.addHomogeneous(0.5f, glm::vec3(0)));
        scene.addBox({-2, -2, -2}, {2, 2, 1}, fog);
        scene.scene.constants.camera.inside = fog;
        expectValue(test::renderPixel(scene.scene, 400000), 3 * 0.1402340562 * std::exp(-0.25), "absorbing");
    }
}

TEST(ReferenceLight, SpheresLightLikeTheirConeHoweverSmallOrLarge) {
    // Radiance L under the angle a about the normal: irradiance pi L sin^2 a.
    for (const float radius : {1e-4f, 0.3f, 1.9f})
        for (const Method method : {Method::Scattering, Method::Both}) {
            if (method == Method::Scattering && radius < 0.01f) continue;
            HandScene scene = floorPatch(glm::vec3(0.5f));
            const std::uint32_t shape = scene.addDiffuse(glm::vec3(0));
            // The camera is at distance 1 from the floor; the light begins 2 above it.
            const std::uint32_t id = scene.addSphere({0, 0, 1 + radius}, radius, shape);
            scene.addAreaLight(shared::kLightSphere, id, shape, glm::vec3(2), method == Method::Both);
            const double sine = radius / (2.0 + radius);
            expectValue(test::renderPixel(scene.scene, 200000), 0.5 * 2 * sine * sine,
                        "radius " + std::to_string(radius));
        }
}

TEST(ReferenceLight, PointAndDirectionalLightsFollowTheirLaws) {  // H63
    for (const bool isPoint : {true, false}) {
        HandScene scene = floorPatch(glm::vec3(0.8f));
        shared::Light light{};
        light.texture = shared::kNone;
        light.type = isPoint ? shared::kLightPoint : shared::kLightDirectional;
        light.emission = glm::vec3(5);
        light.vector = isPoint ? glm::vec3(3, 0, 3) : glm::vec3(-0.6f, 0, -0.8f);
        scene.addLight(light);
        // Intensity over distance 5 squared at cosine 0.8, or irradiance at cosine 0.8.
        expectValue(test::renderPixel(scene.scene, 16), 0.8 / kPi * 0.8 * 5 / (isPoint ? 25 : 1), "delta light");
    }
}

TEST(ReferenceLight, SeveralLightsAddUp) {
    const auto scene = [](bool first, bool second) {
        HandScene scene = floorPatch(glm::vec3(0.8f));
        const std::uint32_t shape = scene.addDiffuse(glm::vec3(0));
        if (first) {
            const std::uint32_t quad = scene.addQuad({0.5f, -0.5f, 0.5f}, {0, 1, 0}, {1, 0, 0}, shape);
            scene.addAreaLight(shared::kLightQuad, quad, shape, glm::vec3(3));
        }
        if (second) {
            shared::Light sun{};
            sun.type = shared::kLightDirectional;
            sun.emission = glm::vec3(1);
            sun.vector = {0.6f, 0, -0.8f};
            scene.addLight(sun);
        }
        return test::renderPixel(scene.scene, 300000);
    };
    const PixelEstimate both = scene(true, true), one = scene(true, false), two = scene(false, true);
    EXPECT_LT(std::abs(both.mean - one.mean - two.mean), kZ * std::hypot(both.error, one.error));
}

TEST(ReferenceLight, SampledEnvironmentHasTheMeanOfTheScattered) {
    // In a medium and on a floor; next-event estimation of a constant sky only adds noise.
    const auto scene = [](bool isSampled) {
        HandScene scene;
        scene.lookAlong({0.2f, 0, -1});
        scene.addQuad({-5, -5, -3}, {10, 0, 0}, {0, 10, 0}, scene.addDiffuse(glm::vec3(0.7f)));
        scene.addBox({-2, -2, -3}, {2, 2, -1}, scene.addNull(scene.addHomogeneous(1, glm::vec3(0.9f), 0.7f)));
        scene.setEnvironment(glm::vec3(1));
        if (isSampled) scene.scene.constants.lights[0].selection = scene.scene.constants.lights[0].cumulative = 1;
        return test::renderPixel(scene.scene, 300000);
    };
    const PixelEstimate scattered = scene(false), sampled = scene(true);
    EXPECT_LT(std::abs(scattered.mean - sampled.mean), kZ * std::hypot(scattered.error, sampled.error));
    EXPECT_NE(scattered.mean, sampled.mean);
}

TEST(ReferenceLight, LightsShineFromTheirFrontOnly) {  // H66
    HandScene scene = unitSquare(Method::Both, false);
    shared::Quad& light = scene.scene.constants.quads[1];
    light.normal = -light.normal;
    EXPECT_EQ(test::renderPixel(scene.scene, 1000).mean, 0);
}

/// Closed room of reflectance r whose every wall emits Le: after n bounces Le (1 - r^(n+1)) / (1 - r).
HandScene enclosure(float reflectance) {
    HandScene scene;
    scene.lookAlong({0.3f, 0.2f, -1});
    const std::uint32_t shape = scene.addDiffuse(glm::vec3(reflectance), shared::kShapeFlipNormal);
    scene.addAreaLight(shared::kLightSphere, scene.addSphere({0.1f, 0, 0.2f}, 2, shape), shape, glm::vec3(0.5f), false);
    return scene;
}

TEST(ReferencePath, DepthLimitCountsBounces) {
    for (std::uint32_t depth = 0; depth < 6; ++depth) {
        HandScene scene = enclosure(0.7f);
        scene.scene.constants.maxDepth = depth;
        const double exact = 0.5 * (1 - std::pow(0.7, depth)) / (1 - 0.7);
        EXPECT_NEAR(test::renderPixel(scene.scene, 100).mean, exact, 2e-6) << depth;
    }
}

TEST(ReferencePath, RouletteKeepsTheMean) {
    for (const std::uint32_t depth : {0u, 3u}) {
        HandScene scene = enclosure(0.7f);
        scene.scene.constants.rouletteDepth = depth;
        expectValue(test::renderPixel(scene.scene, 300000), 0.5 / 0.3, "roulette from " + std::to_string(depth));
    }
}

TEST(ReferencePath, WhiteFurnaceIsWhite) {  // H34: whatever the shape, density and phase function
    HandScene scene;
    scene.lookAt({0.2f, 0.1f, -1}, {24, 24});
    const std::uint32_t white = scene.addDiffuse(glm::vec3(1), shared::kShapeTwoSided);
    const std::uint32_t fog = scene.addNull(scene.addHomogeneous(3, glm::vec3(1), 0.85f));
    const std::uint32_t haze = scene.addNull(scene.addHomogeneous(0.5f, glm::vec3(1), -0.5f));
    scene.addQuad({-3, -3, -6}, {6, 0, 0}, {0, 6, 0}, white);
    scene.addSphere({-1, 0, -3}, 0.8f, fog);
    scene.addSphere({1, 1, -4}, 0.7f, white);
    scene.addBox({0.2f, -2, -4}, {2, 0, -2.5f}, haze);
    scene.setEnvironment(glm::vec3(1));
    scene.scene.constants.rouletteDepth = 5;
    RenderSettings settings;
    settings.sampleCount = 64;
    for (const shared::FilmPixel& pixel : reference::render<float>(scene.scene, settings).pixels)
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(test::estimate(pixel, settings.sampleCount, c).mean, 1, 1e-5);
}

}  // namespace
}  // namespace parhelion
