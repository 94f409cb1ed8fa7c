#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "compile/distribution_table.h"
#include "reference/light/light.h"
#include "support/goodness.h"
#include "support/light_scenes.h"
#include "support/words.h"
#include "unit/compile_fixtures.h"

// Sampled directions against where they must lie by geometry, and lightPdf against the same by quadrature.
namespace parhelion::reference {
namespace {

using test::CellTest;
using test::HandScene;
using test::IndependentNumbers;
using test::lightWords;
using test::meshLight;
using test::partOf;
using test::quadLight;
using test::sphereLight;

using Gauss = boost::math::quadrature::gauss<double, 20>;

double significance() { return sidak(test::kFamilySignificance, 20); }

/// lightPdf of a flat light: of one of its primitives, if it has several.
double pdfOf(const SceneView<double>& view, const Light<double>& light, const glm::dvec3& origin,
             const glm::dvec3& direction, double distance, const glm::dvec3& normal, std::uint32_t primitive = kNone) {
    const double cosine = lightCosine(light, normal, normal, -direction);
    return lightPdf(view, light, primitive, origin, direction, distance, cosine);
}

/// Where on the quad a direction from `position` leads, as (u, v), solved in double.
glm::dvec2 quadParameters(const shared::Quad& quad, const glm::dvec3& position, const glm::dvec3& direction) {
    const glm::dmat3 m(glm::dvec3(quad.edgeU), glm::dvec3(quad.edgeV), -direction);
    return glm::dvec2(glm::inverse(m) * (position - glm::dvec3(quad.corner)));
}

TEST(LightSampling, QuadsAreUniformOverTheirArea) {
    const HandScene scene = quadLight();
    const SceneView<float> view(scene.scene);
    const auto run = [&](const glm::dvec2& bends) {
        CellTest cells(36, significance());
        IndependentNumbers numbers(1);
        for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
            const glm::uvec3 words = lightWords(test::bent(numbers.pair<float>(), bends));
            const auto sample = sampleLight(view, glm::vec3(0.1f), words).value();
            const auto at = quadParameters(scene.scene.constants.quads[0], glm::dvec3(0.1f), sample.direction);
            cells.add(partOf(at.x, 6) * 6 + partOf(at.y, 6));
        }
        return cells;
    };
    run({0, 0}).expectFit("quad");
    run({0.02, 0}).expectMisfit("quad, u bent by 2 %");
    run({0, 0.02}).expectMisfit("quad, v bent by 2 %");
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
        return solidAngle * pdfOf(view, view.lights[0], glm::dvec3(0), direction, distance, quad.normal);
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
        const glm::uvec3 words(numbers.words());
        const glm::dvec3 position{0.1, 0.2, -4};
        const auto sample = sampleLight(view, position, words);
        if (!sample) continue;
        const Light<double>& light = view.lights[selectLight(view, toUniform<double>(words.x))];
        glm::dvec3 normal = -sample->direction;
        if (light.type != shared::kLightSphere && sample->target != kNone) normal = flatNormal(view, sample->target);
        const double pdf = pdfOf(view, light, position, sample->direction, sample->distance, normal, sample->target);
        ASSERT_NEAR(pdf / sample->pdf, 1, 1e-9) << light.type;
        ++compared;
    }
    EXPECT_GT(compared, 50'000);
}

/// A quad and a mesh, of which the quad and a triangle face the origin, or turn their backs on it, and the other
/// triangle the other way round.
HandScene quadAndMesh(bool isTurned, bool isTwoSided) {
    HandScene scene = quadLight();
    std::vector<glm::vec3> vertices{{-2, 0, 2}, {0, 3, 2}, {-3, 0, 2.5f}, {0, 2, -3}, {1, 2, -3}, {0, 3, -3}};
    scene.addTriangles(vertices, scene.addDiffuse(glm::vec3(0)));
    scene.addMeshLight(1, glm::vec3(1));
    shared::SceneConstants& constants = scene.scene.constants;
    if (isTurned) {
        constants.quads[0].normal = -constants.quads[0].normal;
        // By shading normals, which say where the front is: the same numbers then find the same points.
        const std::vector<glm::vec4>& v = scene.scene.triangles;
        for (std::size_t i = 0; i < v.size(); i += 3)
            scene.scene.vertexNormals.insert(
                scene.scene.vertexNormals.end(), 3,
                glm::vec4(glm::cross(glm::vec3(v[i + 2] - v[i]), glm::vec3(v[i + 1] - v[i])), 0));
    }
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
    int fromFront = 0, fromBehind = 0;
    for (int i = 0; i < 10'000; ++i) {
        const glm::uvec3 u(numbers.words());
        const glm::dvec3 origin(0);
        const auto inFront = sampleLight(oneSided, origin, u), behind = sampleLight(turned, origin, u);
        ASSERT_NE(inFront.has_value(), behind.has_value()) << "one side or the other";
        const auto expected = inFront ? *inFront : *behind;
        ++(inFront ? fromFront : fromBehind);
        for (const SceneView<double>& view : views) {
            const auto sample = sampleLight(view, origin, u);
            ASSERT_TRUE(sample);
            EXPECT_EQ(sample->direction, expected.direction);
            EXPECT_EQ(sample->pdf, expected.pdf);
            EXPECT_EQ(sample->radianceOverPdf, expected.radianceOverPdf);
            const Light<double>& light = view.lights[selectLight(view, toUniform<double>(u.x))];
            const glm::dvec3 normal = flatNormal(view, sample->target);
            EXPECT_EQ(pdfOf(view, light, origin, sample->direction, sample->distance, normal, sample->target),
                      pdfOf(view, light, origin, sample->direction, sample->distance, -normal, sample->target));
        }
    }
    // The triangle that turns the other way has 7/9 of the mesh's area: 39 % of the samples.
    EXPECT_GT(fromFront, 5'500);
    EXPECT_GT(fromBehind, 3'500);
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
            const glm::dvec3 d(sampleLight(view, glm::vec3(0), lightWords(u)).value().direction);
            const double sin2 = d.x * d.x + d.y * d.y, oneMinusCos = sin2 / (1 + std::sqrt(std::max(0.0, 1 - sin2)));
            const std::size_t turn = partOf(test::turnOf(d.x, d.y), 3);
            cells.add(partOf(oneMinusCos / width, 6) * 3 + turn);
            tooWide.add(partOf(0.98 * oneMinusCos / width, 6) * 3 + turn);
        }
        cells.expectFit("radius " + std::to_string(radius));
        tooWide.expectMisfit("cone off by 2 %");
        // The pdf over the cone of half angle asin(radius / distance).
        const SceneView<double> exact(scene.scene);
        const double pdf = pdfOf(exact, exact.lights[0], glm::dvec3(0), glm::dvec3(0, 0, 1), 2.0, glm::dvec3(0, 0, -1));
        EXPECT_NEAR(pdf * 2 * kPi<double> * width, 1, 1e-6);
    }
    const HandScene around = sphereLight(3);
    EXPECT_FALSE(sampleLight(SceneView<float>(around.scene), glm::vec3(0), lightWords(glm::vec2(0.3f, 0.4f))));
}

/// Where on the mesh a sample lies, in double: the triangle, and the shares of its base and of its height.
struct MeshPoint {
    int triangle;
    double base, height;
};
MeshPoint meshPoint(const SceneView<float>& view, const glm::uvec3& words) {
    const glm::dvec3 d(sampleLight(view, glm::vec3(0), words).value().direction);
    const double x = 2 * d.x / d.z, y = 2 * d.y / d.z;
    const int i = std::min(int(x), 3);
    return {i, (x - i) / double(test::kTriangleBase), y / (i + 1)};
}

TEST(LightSampling, MeshTrianglesAreChosenByArea) {
    const HandScene scene = meshLight();
    std::vector<double> shares;
    for (int i = 0; i < 4; ++i)
        for (int half = 0; half < 2; ++half) shares.push_back((i + 1) / 10.0 * (half == 0 ? 0.75 : 0.25));
    const auto run = [&](const CompiledScene& compiled) {
        const SceneView<float> view(compiled);
        CellTest cells(shares, significance());
        IndependentNumbers numbers(4);
        for (std::uint64_t n = cells.samplesNeeded(); n > 0; --n) {
            const MeshPoint point = meshPoint(view, numbers.words());
            // Left of the middle of its base a right triangle has three quarters of its area.
            cells.add(std::size_t(2 * point.triangle) + (point.base > 0.5 ? 1u : 0u));
        }
        return cells;
    };
    run(scene.scene).expectFit("mesh");
    CompiledScene even = scene.scene, off = scene.scene;
    even.distributions = buildDistribution(std::vector<double>(4, 1.0)).texels;
    off.distributions[2].x += off.distributions[2].x / 50;
    run(even).expectMisfit("every triangle as often");
    run(off).expectMisfit("one bound off by 2 %");
}

TEST(LightSampling, MeshesAreUniformWithinTheirTriangles) {
    const HandScene scene = meshLight();
    const SceneView<float> view(scene.scene);
    const auto run = [&](const glm::dvec2& bends) {
        CellTest cells(36, significance());
        IndependentNumbers numbers(8);
        for (std::uint64_t n = cells.samplesNeeded(); n > 0; --n) {
            const glm::uvec4 words = numbers.words({0, bends.y, 0, 0});
            const std::uint32_t x = test::bentWithin(scene.scene.distributions, words.x, bends.x);
            const MeshPoint point = meshPoint(view, {x, words.y, words.z});
            cells.add(test::triangleCell(point.base, point.height));
        }
        return cells;
    };
    run({0, 0}).expectFit("within triangles");
    run({0.02, 0}).expectMisfit("within triangles, first number bent by 2 %");
    run({0, 0.02}).expectMisfit("within triangles, second number bent by 2 %");
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
    std::vector<double> shares;
    for (const double power : {1.0, 2.0, 5.0}) shares.push_back(0.5 / 3 + 0.5 * power / 8);
    const auto run = [&](std::size_t index, float factor) {
        SceneView<float> view(compiled);
        view.lights.at(index).cumulative *= factor;
        CellTest cells(shares, significance());
        IndependentNumbers numbers(5);
        for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i)
            cells.add(selectLight(view, numbers.uniform<float>()));
        return cells;
    };
    run(0, 1).expectFit("selection");
    run(0, 1.02f).expectMisfit("first light's bound off by 2 %");
    run(1, 1.02f).expectMisfit("second light's bound off by 2 %");
    const SceneView<float> view(compiled);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(double(view.lights[i].selection), shares[i], 1e-6);
}

TEST(LightSampling, EnvironmentIsUniform) {
    HandScene scene;
    scene.setEnvironment(glm::vec3(1));
    scene.scene.constants.lights[0].selection = scene.scene.constants.lights[0].cumulative = 1;
    const SceneView<float> view(scene.scene);
    CellTest cells(18, significance()), tilted(18, significance());
    IndependentNumbers numbers(6);
    for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
        const auto sample = sampleLight(view, glm::vec3(1), lightWords(numbers.pair<float>())).value();
        const glm::dvec3 d(sample.direction);
        cells.add(partOf((1 - d.z) / 2, 6) * 3 + partOf(test::turnOf(d.x, d.y), 3));
        tilted.add(partOf((1 - d.z) / 2 + 0.01 * (1 - d.z * d.z), 6) * 3 + partOf(test::turnOf(d.x, d.y), 3));
        ASSERT_NEAR(double(sample.pdf) * 4 * kPi<double>, 1, 1e-6);
    }
    cells.expectFit("environment");
    tilted.expectMisfit("denser towards a pole by 1 %");
}

}  // namespace
}  // namespace parhelion::reference
