#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <numeric>
#include <span>

#include "compile/compile_scene.h"
#include "compile/luminance.h"
#include "reference/light/light.h"
#include "reference/volume/phase_function.h"
#include "support/environment_maps.h"
#include "support/hand_scene.h"
#include "support/phase_cases.h"
#include "support/sky_samples.h"
#include "unit/compile_fixtures.h"

// Points that are spread evenly over the square stay so on what they choose from: the variance of a mean over n of them
// falls faster than 1 / n.
namespace parhelion::reference {
namespace {

using test::HandScene;

/// What one sample of stratified words is worth.
using Sample = std::function<double(const glm::uvec4& words)>;

/// n times the variance of the mean of a pixel's first n samples, over pixels.
double scaledVariance(const Sample& sample, std::uint32_t n, int pixels) {
    RunningMoments means;
    for (int pixel = 0; pixel < pixels; ++pixel) {
        double sum = 0;
        for (std::uint32_t i = 0; i < n; ++i)
            sum += sample(drawStratified(streamOf(std::uint32_t(pixel), i, 0, 0), true, 1, shared::kDrawLight));
        means.add(sum / n);
    }
    return n * means.variance();
}

/// Independent points keep n times the variance. Of a smooth integrand scrambled nets have a variance of n^-3 up to
/// logarithms, of one that is piecewise smooth in two dimensions n^-3/2: from n = 16 to 128 n times that falls to 1/64
/// and to 1/2.8. Over 200 pixels each estimate is good to 10 % (one deviation), their ratio to 14 %: 1/2 is 3
/// deviations above 1/2.8, and 1, what samples without neighbourhood have, another 4 above.
void expectStratified(const std::string& what, const Sample& sample) {
    const double few = scaledVariance(sample, 16, 200), many = scaledVariance(sample, 128, 200);
    std::printf("%s: n times variance %.3g at 16, %.3g at 128\n", what.c_str(), few, many);
    EXPECT_LT(many, 0.5 * few) << what;
    // Of the same probabilities, but scattered, as an alias table does.
    const Sample scattered = [&](glm::uvec4 words) {
        words.x = (words.x ^ words.x >> 16) * 0x9e3779b1u;
        return sample(words ^ glm::uvec4(words.x >> 15, 0, 0, 0));
    };
    EXPECT_GT(scaledVariance(scattered, 128, 200), 0.5 * scaledVariance(scattered, 16, 200)) << what << ", scattered";
}

/// Radiance over density times the cosine of a plane that faces `up`, from one point.
Sample irradiance(const SceneView<float>& view, const glm::vec3& position, const glm::vec3& up) {
    return [&view, position, up](const glm::uvec4& words) {
        const auto light = sampleLight(view, position, words);
        if (!light) return 0.0;
        return luminance(glm::dvec3(light->radianceOverPdf)) * std::max(0.0, double(glm::dot(light->direction, up)));
    };
}

EmitterDescription smoothMap() {
    EmitterDescription map = test::madeMap({96, 49}, 140, false);
    for (unsigned j = 0; j < 49; ++j)
        for (unsigned i = 0; i < 96; ++i) {
            const double angle = kPi<double> * j / 48, turn = 2 * kPi<double> * (i + 0.5) / 96;
            const glm::dvec3 d(std::sin(turn) * std::sin(angle), std::cos(angle), -std::cos(turn) * std::sin(angle));
            const double sun = std::exp(20 * (glm::dot(d, glm::normalize(glm::dvec3(1, 2, -1))) - 1));
            map.map.texels[j * 96 + i] = glm::vec3(0.2 + 40 * sun);
        }
    return map;
}

TEST(Stratification, SurvivesOnMaps) {
    HandScene scene;
    scene.setEnvironmentMap(smoothMap());
    const SceneView<float> view(scene.scene);
    expectStratified("map", irradiance(view, glm::vec3(0), {0, 0, 1}));
}

TEST(Stratification, SurvivesOnBandsOfSkies) {
    SkyDescription sky = test::starrySky();
    sky.starDensity = 0;
    HandScene scene;
    scene.setSky(sky);
    const SceneView<float> view(scene.scene);
    expectStratified("bands", irradiance(view, glm::vec3(0), glm::vec3(sky.axis)));
    expectStratified("bands, aslant", irradiance(view, glm::vec3(0), {0, 0, 1}));
}

TEST(Stratification, SurvivesOnStars) {
    SkyDescription sky = test::starrySky(0.5);
    sky.bottom = sky.top = glm::dvec3(0);
    sky.starDensity = 400;
    HandScene scene;
    scene.setSky(sky);
    const SceneView<float> view(scene.scene);
    expectStratified("stars", irradiance(view, glm::vec3(0), {0, 0, 1}));
}

TEST(Stratification, SurvivesInTabulatedPhaseFunctions) {
    const test::PhaseCase droplets("droplets", test::dropletTable(181));
    const auto medium = droplets.medium<float>();
    const glm::vec3 wo = glm::normalize(glm::vec3(0.3f, -0.5f, 0.7f));
    expectStratified("phase function", [&](const glm::uvec4& words) {
        const glm::vec3 wi = samplePhase(medium, wo, words, words.z).direction;
        return std::exp(double(glm::dot(wi, glm::vec3(0, 0.6f, 0.8f))));
    });
}

/// 24 quads in a ring about the axis z, whose brightness goes round smoothly.
TEST(Stratification, SurvivesTheChoiceAmongLights) {
    HandScene scene;
    for (int i = 0; i < 24; ++i) {
        const float turn = 0.25f * float(i), bright = 1.2f + std::cos(turn);
        const std::uint32_t shape = scene.addDiffuse(glm::vec3(0));
        const glm::vec3 corner(2 * std::cos(turn), 2 * std::sin(turn), 2);
        const std::uint32_t quad = scene.addQuad(corner, {0, 0.3f, 0}, {0.3f, 0, 0}, shape);
        scene.addAreaLight(shared::kLightQuad, quad, shape, glm::vec3(bright));
    }
    const SceneView<float> view(scene.scene);
    expectStratified("quads", irradiance(view, glm::vec3(0.2f, 0.1f, 0), {0, 0, 1}));
}

TEST(Stratification, SurvivesOnTrianglesOfMeshLights) {
    SceneDescription description = fixtures::scene();
    description.shapes = {fixtures::emissive(fixtures::soup("ball", test::icosphere(4)), {3, 3, 3})};
    const CompiledScene compiled = compileScene(description);
    ASSERT_GT(compiled.lightTriangles.size(), 5000u);
    const SceneView<float> view(compiled);
    const glm::vec3 center = -glm::vec3(compiled.worldOrigin);
    expectStratified("mesh", irradiance(view, center + glm::vec3(0.5f, 0.4f, -3), {0, 0, 1}));
}

}  // namespace
}  // namespace parhelion::reference
