#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/render_scene.h"
#include "support/rendering.h"

// Direct lighting by any mixture of light and scattering samples has one expectation, known in closed form: a floor of
// reflectance 1/2 under the unit square of radiance 3 at height 1, in a uniform sky of 0.7. The form factor from the
// point below its middle is F = 0.2394564705, and what the square hides of the sky is F too: 0.5 (3 F + 0.7 (1 - F)).
// The field of view, 0.02 degrees at distance 1/2, leaves the point within 1e-4: F changes by 1e-8.
namespace parhelion {
namespace {

using namespace test;

constexpr double kFormFactor = 0.2394564705;
constexpr double kExpected = 0.5 * (3 * kFormFactor + 0.7 * (1 - kFormFactor));
constexpr double kZ = 5.5;  // a family of 1e-6 over 20 comparisons

std::string directXml(const std::string& properties, const std::string& emitters) {
    const std::string square = R"(<shape type="rectangle">
    <transform name="to_world"><scale value="0.5"/><rotate x="1" angle="180"/><translate z="1"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>
    <emitter type="area"><rgb name="radiance" value="3"/></emitter></shape>)";
    const std::string floor = R"(<shape type="rectangle"><bsdf type="diffuse">
    <rgb name="reflectance" value="0.5"/></bsdf></shape>)";
    std::string text =
        sceneXml(floor + (emitters.empty() ? square + R"(<emitter type="constant">
    <rgb name="radiance" value="0.7"/></emitter>)"
                                           : emitters),
                 {.origin = "0, 0, 0.5", .integrator = "<integrator type=\"direct\">" + properties + "</integrator>"});
    const std::string wide = R"(name="fov" value="40")";
    return text.replace(text.find(wide), wide.size(), R"(name="fov" value="0.02")");
}

CompiledScene directScene(const std::string& properties, const std::string& emitters = "") {
    return compileText(directXml(properties, emitters), {32, 32});
}

std::string counts(int emitter, int bsdf) {
    return fmt::format(R"(<integer name="emitter_samples" value="{}"/><integer name="bsdf_samples" value="{}"/>)",
                       emitter, bsdf);
}

std::string strategy(const std::string& name) { return fmt::format(R"(<string name="strategy" value="{}"/>)", name); }

double deviation(const PixelEstimate& estimate) { return (estimate.mean - kExpected) / estimate.error; }

class DirectStrategies : public testing::TestWithParam<Backend> {};

// A bias of 0.7 % is found with probability 0.99: the error is at most 0.08 %.
TEST_P(DirectStrategies, HaveOneExpectation) {
    for (const std::string& properties :
         {strategy("bsdf"), strategy("emitter"), strategy("mis"), counts(4, 1), counts(1, 3)}) {
        const Film film = renderOn(GetParam(), directScene(properties), 2048);
        const PixelEstimate mean = imageMean(film);
        EXPECT_EQ(countAnomalies(film), 0u);
        EXPECT_LT(std::abs(deviation(mean)), kZ) << properties << ": " << mean.mean << " +- " << mean.error;
        EXPECT_LT(mean.error, 8e-4 * kExpected) << properties;
    }
}

// Seeded defects: a light whose density is understated by a tenth, and a dimmer one.
TEST_P(DirectStrategies, WrongDensitiesShow) {
    const auto withDefect = [](const std::string& properties, auto change) {
        CompiledScene scene = directScene(properties);
        change(scene.constants.lights[0]);
        return std::abs(deviation(imageMean(renderOn(GetParam(), scene, 2048))));
    };
    EXPECT_GT(withDefect(strategy("emitter"), [](shared::Light& light) { light.selection *= 0.9f; }), kZ);
    EXPECT_GT(withDefect(strategy("mis"), [](shared::Light& light) { light.emission *= 0.99f; }), kZ);
}

// Straight down on the floor: irradiance 1 of the sun, and of a lamp of intensity 1/4 at distance 1/2.
TEST_P(DirectStrategies, DeltaLightsKeepTheirBrightness) {
    const std::string lights[] = {
        R"(<emitter type="directional"><vector name="direction" x="0" y="0" z="-1"/></emitter>)",
        R"(<emitter type="point"><point name="position" x="0" y="0" z="0.5"/><float name="intensity" value="0.25"/>
</emitter>)"};
    for (const std::string& light : lights) {
        for (const std::string& properties : {strategy("mis"), counts(4, 1)}) {
            const PixelEstimate mean = imageMean(renderOn(GetParam(), directScene(properties, light), 4));
            EXPECT_NEAR(mean.mean, 0.5 / M_PI, 1e-6) << properties;  // no noise: rounding, and the fov's 1e-8
        }
        const CompiledScene lost = directScene(strategy("bsdf"), light);
        ASSERT_FALSE(lost.notes.empty());
        EXPECT_NE(lost.notes.back().find("its light is lost"), std::string::npos) << lost.notes.back();
        EXPECT_EQ(lost.constants.lightCount, 0u);
    }
}

INSTANTIATE_TEST_SUITE_P(OnTheDevice, DirectStrategies, testing::Values(Backend::Vulkan));
INSTANTIATE_TEST_SUITE_P(NightlyOnTheReference, DirectStrategies, testing::Values(Backend::Reference));

// Light sampling never looks at the inside of a sphere: scattering finds its light, whatever the strategy.
TEST(DirectLighting, InsideOfASphereIsSeenByEveryStrategy) {
    const std::string dome = R"(<shape type="sphere"><float name="radius" value="3"/>
    <boolean name="flip_normals" value="true"/><bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>
    <emitter type="area"><rgb name="radiance" value="2"/></emitter></shape>)";
    for (const std::string& properties : {strategy("bsdf"), strategy("emitter"), strategy("mis")})
        EXPECT_NEAR(imageMean(renderOn(Backend::Vulkan, directScene(properties, dome), 4)).mean, 0.5 * 2, 1e-6)
            << properties;
}

TEST(DirectLighting, HasOneBounceWhateverTheCommandLineAsks) {
    CompileOptions options;
    for (const int depth : {-1, 3}) {
        options.maxDepth = depth;
        EXPECT_THROW(compileText(directXml(strategy("mis"), ""), {4, 4}, options), InputError) << depth;
    }
    options.maxDepth = 1;
    EXPECT_EQ(compileText(directXml(strategy("mis"), ""), {4, 4}, options).constants.maxDepth, 1u);
    EXPECT_EQ(directScene(strategy("mis")).constants.maxDepth, 2u);
}

TEST(DirectLighting, NumbersOfSamplesWeighAndAreNoted) {
    const CompiledScene four = directScene(counts(4, 1)), equal = directScene(counts(3, 3));
    EXPECT_EQ(four.constants.emitterSamples, 1.0f);
    EXPECT_EQ(four.constants.scatterSamples, 0.25f);
    EXPECT_TRUE(four.effects.has(Effect::hasStrategyWeights));
    EXPECT_FALSE(equal.effects.has(Effect::hasStrategyWeights));
    ASSERT_FALSE(four.notes.empty());
    EXPECT_NE(four.notes.front().find("only weighs the strategies"), std::string::npos) << four.notes.front();
}

}  // namespace
}  // namespace parhelion
