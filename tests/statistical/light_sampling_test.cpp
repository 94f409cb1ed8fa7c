#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "reference/light/light.h"
#include "support/goodness.h"
#include "support/hand_scene.h"
#include "unit/compile_fixtures.h"

// Sampled directions against where they must lie by geometry, and lightPdf against the same by quadrature.
namespace parhelion::reference {
namespace {

using test::CellTest;
using test::HandScene;
using test::IndependentNumbers;
using test::partOf;

using Gauss = boost::math::quadrature::gauss<double, 20>;

double significance() { return sidak(test::kFamilySignificance, 20); }

glm::vec3 lightPoint(const glm::vec3& u) { return {0, u.y, u.z}; }

/// A sheared quad that faces the origin from above.
HandScene quadLight() {
    HandScene scene;
    const std::uint32_t shape = scene.addDiffuse(glm::vec3(0));
    const std::uint32_t quad = scene.addQuad({0.4f, -0.5f, 1.1f}, {-0.2f, 1.3f, 0.1f}, {0.9f, 0.3f, 0.2f}, shape);
    scene.addAreaLight(shared::kLightQuad, quad, shape, glm::vec3(1));
    if (scene.scene.constants.quads[0].normal.z > 0)
        scene.scene.constants.quads[0].normal = -scene.scene.constants.quads[0].normal;
    return scene;
}

/// Where on the quad a direction from `position` leads, as (u, v), solved in double.
glm::dvec2 quadParameters(const shared::Quad& quad, const glm::dvec3& position, const glm::dvec3& direction) {
    const glm::dmat3 m(glm::dvec3(quad.edgeU), glm::dvec3(quad.edgeV), -direction);
    return glm::dvec2(glm::inverse(m) * (position - glm::dvec3(quad.corner)));
}

TEST(LightSampling, QuadsAreUniformOverTheirArea) {
    const HandScene scene = quadLight();
    const SceneView<float> view(scene.scene);
    const auto run = [&](auto bend) {
        CellTest cells(36, significance());
        IndependentNumbers numbers(1);
        for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
            const glm::vec2 u = bend(numbers.pair<float>());
            const auto sample = sampleLight(view, glm::vec3(0.1f), lightPoint({0, u.x, u.y}));
            const auto at = quadParameters(scene.scene.constants.quads[0], glm::dvec3(0.1f), sample->direction);
            cells.add(partOf(at.x, 6) * 6 + partOf(at.y, 6));
        }
        return cells;
    };
    run([](const glm::vec2& u) { return u; }).expectFit("quad");
    run([](const glm::vec2& u) { return glm::vec2(u.x + 0.02f * u.x * (1 - u.x), u.y); }).expectMisfit("bent by 2 %");
}

TEST(LightSampling, DensityOfQuadsIntegratesToTheShareOfEveryCell) {
    // By change of variables from solid angle to (u, v); each of 3 x 3 cells has 1/9.
    const HandScene scene = quadLight();
    const SceneView<double> view(scene.scene);
    const Quad<double>& quad = view.quads[0];
    const glm::dvec3 areaVector = glm::cross(quad.edgeU, quad.edgeV);
    const auto integrand = [&](double u, double v) {
        const glm::dvec3 point = quad.corner + u * quad.edgeU + v * quad.edgeV;
        const double distance = glm::length(point);
        const glm::dvec3 direction = point / distance;
        const double solidAngle = std::abs(glm::dot(areaVector, direction)) / (distance * distance);
        return solidAngle * lightPdf(view, view.lights[0], glm::dvec3(0), direction, distance, quad.normal);
    };
    for (int i = 0; i < 9; ++i) {
        const double u0 = i / 3 / 3.0, v0 = i % 3 / 3.0;
        const double share = Gauss::integrate(
            [&](double u) { return Gauss::integrate([&](double v) { return integrand(u, v); }, v0, v0 + 1 / 3.0); }, u0,
            u0 + 1 / 3.0);
        // Area and normal are floats.
        EXPECT_NEAR(9 * share, 1, 1e-6);
    }
}

TEST(LightSampling, SampledAndEvaluatedDensitiesAreOne) {
    HandScene scene = quadLight();
    const std::uint32_t ball = scene.addDiffuse(glm::vec3(0));
    scene.addAreaLight(shared::kLightSphere, scene.addSphere({-2, 1, 3}, 0.7f, ball), ball, glm::vec3(1));
    scene.addTriangles(test::icosphere(1), scene.addDiffuse(glm::vec3(0)));
    scene.addMeshLight(2, glm::vec3(1));
    scene.setEnvironment(glm::vec3(1));
    const SceneView<double> view(scene.scene);
    IndependentNumbers numbers(2);
    int compared = 0;
    for (int i = 0; i < 100'000; ++i) {
        const double first = numbers.uniform<double>();
        const glm::dvec2 u = numbers.pair<double>();
        const glm::dvec3 position{0.1, 0.2, -4};
        const auto sample = sampleLight(view, position, glm::dvec3(first, u));
        if (!sample) continue;
        const Light<double>& light = view.lights[selectLight(view, first)];
        glm::dvec3 normal = -sample->direction;
        if (light.type != shared::kLightSphere && sample->target != kNone) normal = flatNormal(view, sample->target);
        const double pdf = lightPdf(view, light, position, sample->direction, sample->distance, normal);
        ASSERT_NEAR(pdf / sample->pdf, 1, 1e-9) << light.type;
        ++compared;
    }
    EXPECT_GT(compared, 50'000);
}

/// A quad and a mesh that face the origin from below, or turn their backs on it.
HandScene quadAndMesh(bool isTurned, bool isTwoSided) {
    HandScene scene = quadLight();
    std::vector<glm::vec3> vertices{{-2, 0, 2}, {0, 3, 2}, {-3, 0, 2.5f}, {0, 2, -3}, {1, 2, -3}, {0, 3, -3}};
    scene.addTriangles(vertices, scene.addDiffuse(glm::vec3(0), isTurned ? shared::kShapeFlipNormal : 0u));
    scene.addMeshLight(1, glm::vec3(1));
    shared::SceneConstants& constants = scene.scene.constants;
    if (isTurned) constants.quads[0].normal = -constants.quads[0].normal;
    for (unsigned i = 0; i < 2 && isTwoSided; ++i) constants.lights[i].flags |= shared::kLightTwoSided;
    return scene;
}

TEST(LightSampling, TwoSidesAreSampledAsTheFrontIs) {
    // Which the tests above check: the same sample whichever side the origin is on.
    const HandScene front = quadAndMesh(false, false), both = quadAndMesh(false, true), back = quadAndMesh(true, true);
    const HandScene dark = quadAndMesh(true, false);
    const SceneView<double> views[] = {SceneView<double>(both.scene), SceneView<double>(back.scene)};
    const SceneView<double> oneSided(front.scene), turned(dark.scene);
    IndependentNumbers numbers(7);
    int seen = 0;
    for (int i = 0; i < 10'000; ++i) {
        const glm::dvec3 u(numbers.uniform<double>(), numbers.pair<double>());
        const glm::dvec3 origin(0);
        auto expected = sampleLight(oneSided, origin, u);
        const auto fromBehind = sampleLight(turned, origin, u);
        EXPECT_NE(expected.has_value(), fromBehind.has_value()) << "one side or the other";
        if (!expected) expected = fromBehind;
        ++seen;
        for (const SceneView<double>& view : views) {
            const auto sample = sampleLight(view, origin, u);
            ASSERT_TRUE(sample);
            EXPECT_EQ(sample->direction, expected->direction);
            EXPECT_EQ(sample->pdf, expected->pdf);
            EXPECT_EQ(sample->radianceOverPdf, expected->radianceOverPdf);
            const Light<double>& light = view.lights[selectLight(view, u.x)];
            EXPECT_EQ(
                lightPdf(view, light, origin, sample->direction, sample->distance, flatNormal(view, sample->target)),
                lightPdf(view, light, origin, sample->direction, sample->distance, -flatNormal(view, sample->target)));
        }
    }
    EXPECT_EQ(seen, 10'000);
}

HandScene sphereLight(float radius) {
    HandScene scene;
    const std::uint32_t shape = scene.addDiffuse(glm::vec3(0));
    scene.addAreaLight(shared::kLightSphere, scene.addSphere({0, 0, 2}, radius, shape), shape, glm::vec3(1));
    return scene;
}

TEST(LightSampling, SpheresAreUniformOverTheirVisibleCone) {
    for (const float radius : {2e-3f, 0.5f, 1.99f}) {
        const HandScene scene = sphereLight(radius);
        const SceneView<float> view(scene.scene);
        const double sine = double(radius) / 2, width = sine * sine / (1 + std::sqrt(1 - sine * sine));
        CellTest cells(18, significance()), tooWide(18, significance());
        IndependentNumbers numbers(3);
        for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
            const glm::vec2 u = numbers.pair<float>();
            const glm::dvec3 d(sampleLight(view, glm::vec3(0), lightPoint({0, u}))->direction);
            const double sin2 = d.x * d.x + d.y * d.y, oneMinusCos = sin2 / (1 + std::sqrt(std::max(0.0, 1 - sin2)));
            const std::size_t turn = partOf(test::turnOf(d.x, d.y), 3);
            cells.add(partOf(oneMinusCos / width, 6) * 3 + turn);
            tooWide.add(partOf(0.98 * oneMinusCos / width, 6) * 3 + turn);
        }
        cells.expectFit("radius " + std::to_string(radius));
        tooWide.expectMisfit("cone off by 2 %");
        // The pdf over the cone of half angle asin(radius / distance).
        const SceneView<double> exact(scene.scene);
        const double pdf =
            lightPdf(exact, exact.lights[0], glm::dvec3(0), glm::dvec3(0, 0, 1), 2.0, glm::dvec3(0, 0, -1));
        EXPECT_NEAR(pdf * 2 * kPi<double> * width, 1, 1e-6);
    }
    const HandScene around = sphereLight(3);
    EXPECT_FALSE(sampleLight(SceneView<float>(around.scene), glm::vec3(0), glm::vec3(0, 0.3f, 0.4f)));
}

TEST(LightSampling, MeshTrianglesAreChosenByArea) {
    // Four triangles of areas 1 : 2 : 3 : 4 side by side, facing the origin.
    HandScene scene;
    std::vector<glm::vec3> vertices;
    for (int i = 0; i < 4; ++i)
        for (const glm::vec3 p : {glm::vec3(0, 0, 2), glm::vec3(0, float(i + 1), 2), glm::vec3(0.9f, 0, 2)})
            vertices.push_back(p + glm::vec3(float(i), 0, 0));
    scene.addTriangles(vertices, scene.addDiffuse(glm::vec3(0)));
    scene.addMeshLight(0, glm::vec3(1));
    const SceneView<float> view(scene.scene);
    std::vector<double> shares;
    for (int i = 0; i < 4; ++i)
        for (int half = 0; half < 2; ++half) shares.push_back((i + 1) / 10.0 * (half == 0 ? 0.75 : 0.25));
    CellTest cells(shares, significance()), even(shares, significance());
    IndependentNumbers numbers(4);
    for (std::uint64_t n = cells.samplesNeeded(); n > 0; --n) {
        const float u = numbers.uniform<float>();
        const glm::dvec3 d(sampleLight(view, glm::vec3(0), glm::vec3(u, numbers.pair<float>()))->direction);
        const double x = 2 * d.x / d.z;
        const int i = std::min(int(x), 3);
        // Left of the middle of its base a right triangle has three quarters of its area.
        cells.add(std::size_t(2 * i) + (x - i > 0.45 ? 1u : 0u));
        even.add(std::size_t(2 * partOf(u, 4)) + (x - i > 0.45 ? 1u : 0u));
    }
    cells.expectFit("mesh");
    even.expectMisfit("every triangle as often");
}

TEST(LightSampling, LightsAreSelectedAsTheCompilerSays) {
    // Half evenly, half by power: point lights of power 1 : 2 : 5.
    SceneDescription description = fixtures::scene();
    for (const double power : {1.0, 2.0, 5.0}) {
        EmitterDescription bulb;
        bulb.type = EmitterDescription::Type::Point;
        bulb.value = glm::dvec3(power);
        bulb.vector = {power, 0, 0};
        description.emitters.push_back(bulb);
    }
    const CompiledScene compiled = compileScene(description);
    const SceneView<float> view(compiled);
    std::vector<double> shares, even(3, 1 / 3.0);
    for (const double power : {1.0, 2.0, 5.0}) shares.push_back(0.5 / 3 + 0.5 * power / 8);
    CellTest cells(shares, significance()), defect(even, significance());
    IndependentNumbers numbers(5);
    for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
        const std::size_t chosen = selectLight(view, numbers.uniform<float>());
        cells.add(chosen);
        defect.add(chosen);
        ASSERT_NEAR(double(view.lights[chosen].selection), shares[chosen], 1e-6);
    }
    cells.expectFit("selection");
    defect.expectMisfit("even selection");
}

TEST(LightSampling, EnvironmentIsUniform) {
    HandScene scene;
    scene.setEnvironment(glm::vec3(1));
    scene.scene.constants.lights[0].selection = scene.scene.constants.lights[0].cumulative = 1;
    const SceneView<float> view(scene.scene);
    CellTest cells(18, significance()), tilted(18, significance());
    IndependentNumbers numbers(6);
    for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
        const auto sample = sampleLight(view, glm::vec3(1), lightPoint({0, numbers.pair<float>()}));
        const glm::dvec3 d(sample->direction);
        cells.add(partOf((1 - d.z) / 2, 6) * 3 + partOf(test::turnOf(d.x, d.y), 3));
        tilted.add(partOf((1 - d.z) / 2 + 0.01 * (1 - d.z * d.z), 6) * 3 + partOf(test::turnOf(d.x, d.y), 3));
        ASSERT_NEAR(double(sample->pdf) * 4 * kPi<double>, 1, 1e-6);
    }
    cells.expectFit("environment");
    tilted.expectMisfit("denser towards a pole by 1 %");
}

}  // namespace
}  // namespace parhelion::reference
