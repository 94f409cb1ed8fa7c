#include <gtest/gtest.h>

#include <cmath>

#include "reference/light/light.h"
#include "support/goodness.h"
#include "support/light_scenes.h"

// E[1 / pdf] of sampled directions is the solid angle of what they are sampled from; of maps:
// environment_sampling_test, of skies: sky_sampling_test.
namespace parhelion::reference {
namespace {

using test::HandScene;

constexpr int kSamples = 2'000'000;

double significance() { return sidak(test::kFamilySignificance, 3); }

/// Source: Van Oosterom, Strackee 1983, "The Solid Angle of a Plane Triangle".
double solidAngle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    return 2 * std::atan2(std::abs(glm::dot(a, glm::cross(b, c))),
                          la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

/// Of the directions from the origin to the scene's one light.
RunningMoments inverseDensities(const CompiledScene& scene) {
    const SceneView<float> view(scene);
    test::IndependentNumbers numbers(1);
    RunningMoments moments;
    for (int i = 0; i < kSamples; ++i) {
        const auto sample = sampleLight(view, glm::vec3(0), numbers.words());
        moments.add(1 / double(sample.value().pdf));
    }
    return moments;
}

TEST(LightSolidAngles, OfQuads) {
    HandScene scene = test::quadLight();
    shared::Quad& quad = scene.scene.constants.quads[0];
    const glm::dvec3 corner(quad.corner), u(quad.edgeU), v(quad.edgeV);
    const double exact =
        solidAngle(corner, corner + u, corner + u + v) + solidAngle(corner, corner + u + v, corner + v);
    test::expectResolvedMean(inverseDensities(scene.scene), exact, significance(), "quad");
    quad.area *= 1.02f;
    EXPECT_FALSE(test::agrees(inverseDensities(scene.scene), exact, significance())) << "area off by 2 %";
}

TEST(LightSolidAngles, OfMeshes) {
    const HandScene scene = test::meshLight();
    double exact = 0;
    for (int i = 0; i < 4; ++i) {
        const std::vector<glm::vec3> v = test::triangleVertices(i);
        exact += solidAngle(glm::dvec3(v[0]), glm::dvec3(v[1]), glm::dvec3(v[2]));
    }
    test::expectResolvedMean(inverseDensities(scene.scene), exact, significance(), "mesh");
    // Of triangles that are ever further away: one that is chosen too rarely is missed.
    CompiledScene off = scene.scene;
    for (std::size_t i = 0; i < 3; ++i) off.distributions[i + 1].x += off.distributions[i + 1].x / 50;
    EXPECT_FALSE(test::agrees(inverseDensities(off), exact, significance())) << "bounds off by 2 %";
}

TEST(LightSolidAngles, OfSpheres) {
    for (const float radius : {2e-3f, 0.5f, 1.9f}) {
        const HandScene scene = test::sphereLight(radius);
        const double sine = double(radius) / 2;
        const double exact = 2 * kPi<double> * sine * sine / (1 + std::sqrt(1 - sine * sine));
        // The density is constant, so that roundings are all there is to see: those of 1 - sin^2 grow by 1 / (1 -
        // sin^2).
        const double tolerance = 16 * 0x1p-24 / (1 - sine * sine);
        EXPECT_NEAR(inverseDensities(scene.scene).mean() / exact, 1, tolerance) << radius;
    }
}

}  // namespace
}  // namespace parhelion::reference
