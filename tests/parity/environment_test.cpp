// shaders/light/environment.glsl against double precision, against the definition of the map, and against Mitsuba.
#include <gtest/gtest.h>

#include "reference/light/surrounding.h"
#include "support/environment_maps.h"
#include "support/environment_table.h"
#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/paths.h"
#include "support/scene_probe.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::HandScene;
using test::Parity;
using test::Stress;

const char* const kShader = "parity/environment.comp";
enum Function : std::uint32_t { kPlace, kAt, kSample, kSurrounding };

constexpr glm::uvec2 kSizes[] = {{2, 3}, {1, 5}, {7, 4}, {64, 32}, {512, 300}};

HandScene mapScene(const EmitterDescription& map) {
    HandScene scene;
    scene.setEnvironmentMap(map);
    return scene;
}

/// Random directions; poles, seam, edges and centres of texels and what is next to them.
std::vector<glm::vec4> directionsFor(const EmitterDescription& map, std::size_t random) {
    std::vector<glm::vec4> inputs;
    for (const glm::vec3& d : test::stressDirections(random)) inputs.emplace_back(d, 0);
    Stress stress(71);
    for (std::size_t i = 0; i < random; ++i) {
        const double quarter = 0.5 * std::floor(stress.between(0, 2) * float(map.map.size.x)) / map.map.size.x;
        const double turn = 6.283185307179586 * (i % 4 ? quarter : double(stress.between(-1e-6f, 1e-6f)));
        const double steps = std::max(map.map.size.y, 3u) - 1.0;
        const double angle = 3.14159265358979 * 0.5 * std::floor(stress.between(0, 2) * float(steps + 0.99)) / steps;
        const glm::dvec3 local(std::sin(turn) * std::sin(angle), std::cos(angle), -std::cos(turn) * std::sin(angle));
        inputs.emplace_back(glm::vec3(glm::normalize(glm::dmat3(map.toWorld) * local)), 0);
    }
    return inputs;
}

/// Roundings of the direction in map space (three products, two sums, and those of the rotation) and of the angle.
constexpr double kRoundings = 8;

// A place moves by the roundings of the direction, which near a pole turn the azimuth, and those of the two angles.
TEST(EnvironmentParity, PlacesAgreeUpToTheRoundingOfTheDirection) {
    Parity parity("light/environment", "environmentPlace", kRoundings);
    for (const glm::uvec2& size : kSizes) {
        const EmitterDescription map = test::madeMap(size, 140);
        const HandScene scene = mapScene(map);
        const reference::SceneView<double> view(scene.scene);
        const auto inputs = directionsFor(map, 2'000);
        const auto outputs = test::SceneProbe(scene.scene).run(kShader, kPlace, inputs);
        const double rows = scene.scene.constants.environmentMap.height - 1.0, width = size.x;
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const glm::uvec4 words = glm::floatBitsToUint(outputs[i]);
            const glm::dvec3 d(inputs[i]);
            const auto expected = reference::environmentPlace(view, d);
            ASSERT_LT(words.x, size.x);
            ASSERT_LT(words.y, rows);
            EXPECT_TRUE(outputs[i].z >= 0 && outputs[i].z <= 1 && outputs[i].w >= 0 && outputs[i].w <= 1);
            double across = double(words.x) + outputs[i].z - expected.column - expected.fraction.x;
            across -= width * std::round(across / width);
            const double sine = test::mapPoint(map, d).sine;
            if (sine > 1e-6) {
                EXPECT_TRUE(parity.near(across, 0, width * (1 + 0.16 / sine))) << i << ' ' << size.x;
            }
            EXPECT_TRUE(parity.near(double(words.y) + outputs[i].w, expected.row + expected.fraction.y, rows)) << i;
        }
    }
}

TEST(EnvironmentParity, RadianceIsTheMapsUpToTheRoundingOfThePlace) {
    Parity parity("light/environment", "environmentAt", 6);  // weights 2, products 2, sums 2
    for (const glm::uvec2& size : kSizes) {
        const EmitterDescription map = test::madeMap(size, 140);
        const HandScene scene = mapScene(map);
        const reference::SceneView<double> view(scene.scene);
        const auto inputs = directionsFor(map, 2'000);
        const auto outputs = test::SceneProbe(scene.scene).run(kShader, kAt, inputs);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const glm::dvec3 d(inputs[i]);
            const test::ColourRange range = test::mapRange(map, d, kRoundings);
            const auto expected = reference::environmentAt(view, d);
            for (int c = 0; c < 3; ++c) {
                const double nearest = std::clamp(double(outputs[i][c]), range.low[c], range.high[c]);
                EXPECT_TRUE(parity.near(outputs[i][c], nearest)) << i << " of " << size.x << 'x' << size.y;
                EXPECT_GE(expected.radiance[c], range.low[c] * (1 - 1e-6));
                EXPECT_LE(expected.radiance[c], range.high[c] * (1 + 1e-6));
            }
            // The density is a cell's: equal but at the edges, where rounding may choose the other.
            const auto place = reference::environmentPlace(view, d);
            const double sine = std::max(test::mapPoint(map, d).sine, 1e-7);
            const double edge = kRoundings * 0x1p-24 * size.x * (1 + 0.16 / sine);
            const double rowEdge = kRoundings * 0x1p-24 * scene.scene.constants.environmentMap.height;
            const glm::dvec2 inner = glm::min(place.fraction, 1.0 - place.fraction);
            if (inner.x > edge && inner.y > rowEdge) {
                EXPECT_EQ(outputs[i].w, float(expected.pdf)) << i;
            }
        }
    }
}

TEST(EnvironmentParity, SamplesAgree) {
    // Of a unit vector: its height 2, sine 3, azimuth 2 pi * 3 (two sums and a quotient) and 1.5, turning it 3,
    // length 3.
    Parity parity("light/environment", "sampleEnvironment", 3 * 32);
    for (const glm::uvec2& size : kSizes) {
        const HandScene scene = mapScene(test::madeMap(size, 140));
        const reference::SceneView<double> view(scene.scene);
        std::vector<glm::vec4> inputs;
        Stress stress(72);
        for (int i = 0; i < 10'000; ++i) {
            glm::uvec4 words;
            for (int c = 0; c < 4; ++c) words[c] = i % 16 == c ? (i % 32 < 16 ? 0u : 0xffffffffu) : stress.word();
            inputs.push_back(glm::uintBitsToFloat(words));
        }
        const auto outputs = test::SceneProbe(scene.scene).run(kShader, kSample, inputs);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const auto expected = reference::sampleEnvironment(view, glm::floatBitsToUint(inputs[i]));
            EXPECT_TRUE(parity.near(glm::dvec3(outputs[i]), expected.direction)) << i;
            EXPECT_EQ(outputs[i].w, float(expected.pdf)) << i;
            EXPECT_GT(outputs[i].w, 0);
        }
    }
}

/// Constant, of a smooth map (radiance over density does not magnify the direction's rounding), of a sky.
std::vector<HandScene> surroundings() {
    std::vector<HandScene> scenes(3);
    scenes[0].setEnvironment({1, 2, 3});
    scenes[0].scene.constants.lights[0].selection = 1;
    scenes[1].setEnvironmentMap(test::madeMap({7, 4}, 140, false));
    SkyDescription sky;
    sky.top = {1, 2, 3};
    sky.bottom = {0.5, 0.5, 0.5};
    scenes[2].setSky(sky);
    return scenes;
}

TEST(EnvironmentParity, SamplesOfSurroundingLightsAgree) {
    // The direction 3 * 32, its effect on a map of 7 x 4 texels of contrast 10 or so: times 7 and 10; relative.
    Parity parity("light/surrounding", "sampleSurrounding", 3 * 32 * 70);
    for (const HandScene& scene : surroundings()) {
        const reference::SceneView<double> view(scene.scene);
        std::vector<glm::vec4> inputs;
        Stress stress(73);
        for (int i = 0; i < 3'000; ++i) {
            glm::uvec4 words;
            for (int c = 0; c < 4; ++c) words[c] = stress.word();
            inputs.push_back(glm::uintBitsToFloat(words));
        }
        const auto outputs = test::SceneProbe(scene.scene).run(kShader, kSurrounding, inputs, 1, 2);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const glm::uvec4 words = glm::floatBitsToUint(inputs[i]);
            if (view.lights[0].type == shared::kLightSky) {
                // Next to the borders of the sky's bands rounding finds the next.
                const std::span<const glm::uvec2> table(scene.scene.distributions);
                if (std::abs(reference::invertDistribution(table, words.x, 0.5).offset - 0.5) > 0.49) continue;
            }
            const auto expected = reference::sampleSurrounding(view, view.lights[0], words);
            ASSERT_TRUE(expected);
            EXPECT_TRUE(parity.near(glm::dvec3(outputs[2 * i]), expected->direction)) << i;
            EXPECT_TRUE(parity.near(outputs[2 * i].w, expected->pdf)) << i;
            for (int c = 0; c < 3; ++c)
                EXPECT_TRUE(parity.near(outputs[2 * i + 1][c], expected->radianceOverPdf[c])) << i;
            EXPECT_TRUE(std::isinf(outputs[2 * i + 1].w));
        }
    }
}

// The seam (H60): on both of its sides and on it.
TEST(EnvironmentParity, IsContinuousAcrossItsSeam) {
    const EmitterDescription map = test::madeMap({16, 8}, 0, false);
    std::vector<glm::vec4> inputs;
    for (const float height : {-0.9f, -0.3f, 0.0f, 0.5f, 0.99f})
        for (const float x : {-1e-7f, -0.0f, 0.0f, 1e-7f})
            for (const float z : {-1.0f, 1.0f})
                inputs.emplace_back(glm::normalize(glm::vec3(x, height, z * std::sqrt(1 - height * height))), 0);
    const auto outputs = test::SceneProbe(mapScene(map).scene).run(kShader, kAt, inputs);
    for (std::size_t i = 0; i + 2 < inputs.size(); i += 8)
        for (std::size_t side = i; side < i + 2; ++side)
            for (std::size_t step = side; step < i + 8; step += 2)
                EXPECT_LT(glm::length(glm::vec3(outputs[step]) - glm::vec3(outputs[side])), 1e-5f) << i;
}

TEST(EnvironmentAgainstMitsuba, RadianceIsTheSame) {
    test::expectTableAgrees(std::filesystem::path(test::projectFolder()) / "tests/references/environment_maps.csv", {},
                            kShader, kAt);
}

}  // namespace
}  // namespace parhelion
