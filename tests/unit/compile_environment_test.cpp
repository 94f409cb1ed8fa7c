#include "compile/compile_environment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "image/image.h"
#include "support/environment_maps.h"
#include "support/scene_reading.h"
#include "support/temporary_folder.h"
#include "unit/compile_fixtures.h"

namespace parhelion {
namespace {

CompiledScene compiled(const EmitterDescription& map) {
    SceneDescription description = fixtures::scene();
    description.emitters = {map};
    return compileScene(description);
}

EmitterDescription uniformMap(glm::uvec2 size, glm::vec3 colour) {
    EmitterDescription map = test::madeMap(size);
    map.map.texels.assign(std::size_t(size.x) * size.y, colour);
    return map;
}

TEST(CompiledEnvironment, OfOneColourIsAConstantEmitter) {
    for (const glm::uvec2 size : {glm::uvec2(1), glm::uvec2(8, 4)}) {
        EmitterDescription map = uniformMap(size, {1, 2, 3});
        map.value = glm::dvec3(0.5);
        const CompiledScene scene = compiled(map);
        ASSERT_EQ(scene.constants.lightCount, 1u);
        EXPECT_EQ(scene.constants.lights[0].type, shared::kLightEnvironment);
        EXPECT_EQ(scene.constants.environmentRadiance, glm::vec3(0.5f, 1, 1.5f));
        EXPECT_FALSE(scene.effects.has(Effect::hasEnvironmentMap));
    }
}

TEST(CompiledEnvironment, DropsWhatIsBlackWithANote) {
    EmitterDescription scaled = test::madeMap({8, 4});
    scaled.value = glm::dvec3(0);
    for (const EmitterDescription& map : {uniformMap({8, 4}, {0, 0, 0}), scaled}) {
        const CompiledScene scene = compiled(map);
        EXPECT_EQ(scene.constants.environment, shared::kNone);
        ASSERT_EQ(scene.notes.size(), 1u);
        EXPECT_NE(scene.notes[0].find("environment map: its light is black"), std::string::npos);
    }
}

TEST(CompiledEnvironment, IsASampledEnvironment) {
    const CompiledScene scene = compiled(test::madeMap({8, 4}));
    EXPECT_EQ(scene.constants.environment, 0u);
    EXPECT_EQ(scene.constants.lights[0].type, shared::kLightEnvironmentMap);
    EXPECT_EQ(scene.constants.lights[0].selection, 1.0f);
    for (const Effect effect : {Effect::hasEnvironment, Effect::hasEnvironmentSampling, Effect::hasEnvironmentMap})
        EXPECT_TRUE(scene.effects.has(effect));
}

TEST(CompiledEnvironment, MeanRadianceIsTheIntegralOfTheFilteredMap) {
    for (const glm::uvec2 size : {glm::uvec2(1, 5), glm::uvec2(3, 2), glm::uvec2(16, 9)}) {
        EmitterDescription map = test::madeMap(size);
        map.value = glm::dvec3(2);
        CompiledScene scene;
        const glm::dvec3 mean = compileEnvironment(map, false, scene);
        constexpr int kPoints = 2880;  // a multiple of the cells' edges
        glm::dvec3 sum(0);
        for (int j = 0; j < kPoints; ++j)
            for (unsigned i = 0; i < 4 * size.x; ++i) {
                const double v = (j + 0.5) / kPoints;
                sum += std::sin(std::numbers::pi * v) * test::mapRadiance(map, (i + 0.5) / (4 * size.x), v);
            }
        sum *= std::numbers::pi / (2.0 * kPoints * 4 * size.x);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c] / sum[c], 1, 1e-6) << size.x;
    }
}

TEST(CompiledEnvironment, CompensationLeavesOutWhatIsBelowTheMean) {
    EmitterDescription map = test::madeMap({32, 17}, 0, false);
    map.map.texels[200] = glm::vec3(30);
    CompiledScene plain, compensated;
    compileEnvironment(map, false, plain);
    compileEnvironment(map, true, compensated);
    const auto count = [](const CompiledScene& scene) {
        return std::ranges::count_if(scene.environmentTexels, [](const glm::vec4& texel) { return texel.w > 0; });
    };
    EXPECT_EQ(count(plain), 32 * 16);
    EXPECT_GT(count(compensated), 0);
    EXPECT_LT(count(compensated), 32 * 8);
}

TEST(CompiledEnvironment, CompensatesOnlyWhereScatteringFindsTheRest) {
    SceneDescription description = fixtures::scene();
    EmitterDescription map = test::madeMap({8, 4});
    map.misCompensation = true;
    description.emitters = {map};
    description.integrator.scatterSamples = 0;
    const CompiledScene scene = compileScene(description);
    ASSERT_EQ(scene.notes.size(), 1u);
    for (std::size_t i = 0; i < 8 * 3; ++i) EXPECT_GT(scene.environmentTexels[i].w, 0) << i;
}

TEST(CompiledEnvironment, RefusesAScaleBeyondSinglePrecision) {
    EmitterDescription map = test::madeMap({32, 16});
    map.value = glm::dvec3(1e34);
    map.where = {"sky.xml", 3, 5};
    try {
        compiled(map);
        FAIL() << "was accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.where().line, 3);
        EXPECT_NE(std::string(error.what()).find("column 10, row 5"), std::string::npos) << error.what();
    }
}

TEST(EnvironmentReader, ReadsEveryPropertyAndItsDefault) {
    const test::TemporaryFolder folder;
    Image image;
    image.size = {2, 1};
    for (const char* channel : {"R", "G", "B"}) image.channels[channel] = {1, 2};
    writeExr(folder.path() / "map.exr", image);
    const std::string name = "<string name=\"filename\" value=\"" + (folder.path() / "map.exr").string() + "\"/>";
    const auto read = [&](const std::string& properties) {
        return test::readText(test::sceneOf("<emitter type=\"envmap\">" + name + properties + "</emitter>"))
            .emitters.at(0);
    };
    const EmitterDescription plain = read("");
    EXPECT_EQ(plain.type, EmitterDescription::Type::EnvironmentMap);
    EXPECT_EQ(plain.map.size, glm::uvec2(2, 1));
    EXPECT_EQ(plain.value, glm::dvec3(1));
    EXPECT_EQ(plain.toWorld, glm::dmat4(1));
    EXPECT_FALSE(plain.misCompensation);
    const EmitterDescription full =
        read(R"(<float name="scale" value="2.5"/><boolean name="mis_compensation" value="true"/>
        <transform name="to_world"><rotate y="1" angle="90"/></transform>)");
    EXPECT_EQ(full.value, glm::dvec3(2.5));
    EXPECT_TRUE(full.misCompensation);
    EXPECT_NEAR(full.toWorld[2].x, 1, 1e-15);
}

}  // namespace
}  // namespace parhelion
