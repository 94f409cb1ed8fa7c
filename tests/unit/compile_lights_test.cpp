#include "compile/compile_lights.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

#include "unit/compile_fixtures.h"

namespace parhelion {
namespace {

using namespace fixtures;

EmitterDescription emitter(EmitterDescription::Type type, const glm::dvec3& value,
                           const glm::dvec3& vector = {0, 0, 1}) {
    EmitterDescription result;
    result.type = type;
    result.where = {"lights.xml", 2, 2};
    result.value = value;
    result.vector = vector;
    return result;
}

constexpr auto kDirectional = EmitterDescription::Type::Directional;
constexpr auto kPoint = EmitterDescription::Type::Point;
constexpr auto kConstant = EmitterDescription::Type::Constant;

void expectExactSelection(const shared::SceneConstants& constants) {
    double sum = 0.0;
    for (unsigned i = 0; i < constants.lightCount; ++i) {
        const shared::Light& light = constants.lights[i];
        sum += light.selection;  // multiples of 2^-24: exact
        EXPECT_EQ(double(light.cumulative), sum) << i;
        EXPECT_EQ(std::fmod(double(light.selection), 0x1p-24), 0.0) << i;
        const bool followsUnsampled = i > 0 && constants.lights[i - 1].selection == 0.0f;
        EXPECT_FALSE(followsUnsampled && light.selection > 0.0f) << "sampled ones come first";
    }
    EXPECT_EQ(sum, 1.0);
}

TEST(LightSelection, MixesUniformAndPower) {
    SceneDescription description = scene();
    description.shapes = {emissive(rectangle("quad", scaling({0.5, 0.5, 1})), {3, 3, 3}),
                          emissive(sphere("ball", {5, 0, 0}, 0.5), {1, 1, 1})};
    description.emitters = {emitter(kPoint, {2, 2, 2}, {1, 2, 3})};
    const CompiledScene compiled = compileScene(description);
    expectExactSelection(compiled.constants);
    // pi A L, pi A L, 4 pi I, over pi
    const double powers[] = {3.0, std::numbers::pi, 8.0};
    const double total = powers[0] + powers[1] + powers[2];
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(compiled.constants.lights[i].selection, 0.5 / 3 + 0.5 * powers[i] / total, 0x1p-24) << i;
    EXPECT_EQ(compiled.shapes[0].light, 0u);
    EXPECT_EQ(compiled.shapes[1].light, 1u);
    EXPECT_EQ(compiled.constants.lights[1].primitive, 1u) << "spheres are numbered after the quad";
    EXPECT_EQ(compiled.constants.lights[2].vector, glm::vec3(1, 2, 13));
    EXPECT_EQ(compiled.constants.shapes[1].light, 1u) << "the inline copy";
}

TEST(LightSelection, TwoSidedLightsHaveTwiceThePower) {
    SceneDescription description = scene();
    description.shapes = {emissive(rectangle("one side", scaling({0.5, 0.5, 1})), {1, 1, 1}),
                          emissive(rectangle("both sides", scaling({0.5, 0.5, 1})), {1, 1, 1})};
    description.shapes[1].emitsOnBothSides = true;
    const CompiledScene compiled = compileScene(description);
    const shared::Light* lights = compiled.constants.lights;
    EXPECT_EQ(lights[0].flags, 0u);
    EXPECT_EQ(lights[1].flags, shared::kLightTwoSided);
    EXPECT_NEAR(lights[0].selection, 0.25 + 0.5 / 3, 0x1p-24);
    EXPECT_NEAR(lights[1].selection, 0.25 + 1.0 / 3, 0x1p-24);
}

TEST(LightSelection, SpheresThatEmitInwardsAreSampledIfTheyEmitOutwardsAsWell) {
    SceneDescription description = scene();
    description.shapes = {emissive(sphere("ball", {5, 0, 0}, 0.5), {1, 1, 1})};
    description.shapes[0].flipNormals = true;
    EXPECT_EQ(compileScene(description).constants.lights[0].selection, 0.0f);
    description.shapes[0].emitsOnBothSides = true;
    EXPECT_EQ(compileScene(description).constants.lights[0].selection, 1.0f);
}

TEST(LightSelection, SumsToOneForAnyPowers) {
    for (const std::size_t count : {1u, 2u, 3u, 7u, 256u}) {
        std::vector<shared::Light> lights(count);
        std::vector<double> powers(count);
        for (std::size_t i = 0; i < count; ++i) powers[i] = std::pow(10.0, double(i * 37 % 601) - 300.0);
        assignSelection(powers, lights);
        double sum = 0.0;
        for (const shared::Light& light : lights) {
            // Half a share of the uniform part, less the rounding of both ends.
            EXPECT_GE(light.selection, 0.5 / double(count) - 0x1p-24);
            sum += light.selection;
            EXPECT_EQ(double(light.cumulative), sum);
        }
        EXPECT_EQ(sum, 1.0);
    }
}

TEST(LightSelection, ConstantEnvironmentIsSampledOnRequestOnly) {
    SceneDescription description = scene();
    description.shapes = {sphere("s", {}, 1)};
    description.emitters = {emitter(kConstant, {1, 2, 3}), emitter(kDirectional, {1, 1, 1}, {0, 0, 2})};
    const CompiledScene usual = compileScene(description);
    expectExactSelection(usual.constants);
    EXPECT_EQ(usual.constants.environment, 1u) << "after the sampled light";
    EXPECT_EQ(usual.constants.lights[1].selection, 0.0f);
    EXPECT_EQ(usual.constants.lights[0].vector, glm::vec3(0, 0, 1)) << "a unit vector";
    EXPECT_EQ(usual.constants.environmentRadiance, glm::vec3(1, 2, 3));

    CompileOptions options;
    options.sampleEveryLight = true;
    const CompiledScene sampled = compileScene(description, options);
    expectExactSelection(sampled.constants);
    EXPECT_EQ(sampled.constants.environment, 0u);
    EXPECT_GT(sampled.constants.lights[0].selection, sampled.constants.lights[1].selection);
}

TEST(LightSelection, NoSampledLightMeansNoSelection) {
    SceneDescription description = scene();
    description.emitters = {emitter(kConstant, {1, 1, 1})};
    const shared::SceneConstants constants = compileScene(description).constants;
    EXPECT_EQ(constants.lights[0].selection, 0.0f);
    EXPECT_EQ(constants.lights[0].cumulative, 0.0f);
    EXPECT_EQ(compileScene(scene()).constants.environment, shared::kNone);
}

TEST(CompiledLights, BlackOnesAreDroppedWithANote) {
    SceneDescription description = scene();
    description.shapes = {emissive(rectangle("quad"), {0, 0, 0})};
    description.emitters = {emitter(kPoint, {0, 0, 0}), emitter(kConstant, {0, 0, 0})};
    const CompiledScene compiled = compileScene(description);
    EXPECT_EQ(compiled.constants.lightCount, 0u);
    EXPECT_EQ(compiled.constants.environment, shared::kNone);
    EXPECT_EQ(compiled.shapes.at(0).light, shared::kNone) << "the surface stays";
    EXPECT_EQ(compiled.notes.size(), 3u);
}

TEST(CompiledLights, ASphereThatEmitsInwardsIsNeverSampled) {
    SceneDescription description = scene();
    description.shapes = {emissive(sphere("room", {}, 20), {1, 1, 1}), emissive(sphere("lamp", {}, 1), {1, 1, 1})};
    description.shapes[0].flipNormals = true;
    const CompiledScene compiled = compileScene(description);
    EXPECT_EQ(compiled.shapes[0].light, 1u);
    EXPECT_EQ(compiled.constants.lights[1].selection, 0.0f);
    EXPECT_EQ(compiled.constants.lights[0].selection, 1.0f);
    EXPECT_EQ(compiled.constants.spheres[0].flags, shared::kShapeFlipNormal);
}

/// The table of a mesh light, and what its words make of the triangles' areas.
void expectChosenByArea(const CompiledScene& compiled, const shared::Light& light, const std::vector<double>& areas) {
    const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
    double running = 0.0;
    for (unsigned i = 0; i < areas.size(); ++i) {
        const glm::uvec2* entry = &compiled.distributions[light.distribution + i];
        EXPECT_NEAR(entry->x * 0x1p-32, running / total, 0x1p-32);
        running += areas[i];
        // Rounded once.
        const double chance = (entry[1].x - entry->x) * 0x1p-32;
        const std::uint32_t primitive = compiled.lightTriangles[light.triangleOffset + i];
        const float stored = compiled.triangleAreas[primitive - compiled.constants.quadCount];
        EXPECT_NEAR(stored * chance / areas[i], 1, 0x1p-23);
    }
    EXPECT_EQ(compiled.distributions[light.distribution + areas.size()].x, 0u);
}

TEST(CompiledLights, MeshTrianglesAreListedByArea) {
    // Two mesh lights whose triangles the BVH may interleave.
    SceneDescription description = scene();
    description.shapes = {emissive(tetrahedron("a", scaling({1, 2, 3})), {1, 1, 1}), rectangle("floor"),
                          emissive(tetrahedron("b", translation({0.1, 0.1, 0.1})), {1, 1, 1})};
    const CompiledScene compiled = compileScene(description);
    const shared::SceneConstants& constants = compiled.constants;
    ASSERT_EQ(constants.lightCount, 2u);
    ASSERT_EQ(compiled.distributions.size(), 10u);
    ASSERT_EQ(compiled.triangleAreas.size(), constants.triangleCount);
    ASSERT_EQ(compiled.lightTriangles.size(), 8u);
    for (unsigned l = 0; l < 2; ++l) {
        const shared::Light& light = constants.lights[l];
        EXPECT_EQ(light.type, shared::kLightMesh);
        EXPECT_EQ(light.triangleOffset, 4 * l);
        EXPECT_EQ(light.distribution, 5 * l);
        EXPECT_EQ(light.triangleCount, 4u);
        EXPECT_EQ(light.primitive, compiled.lightTriangles[light.triangleOffset]);
        std::vector<double> areas;
        for (unsigned i = 0; i < 4; ++i) {
            const std::uint32_t primitive = compiled.lightTriangles[light.triangleOffset + i];
            ASSERT_GE(primitive, constants.quadCount);
            const glm::vec4* t = &compiled.triangles[3 * (primitive - constants.quadCount)];
            EXPECT_EQ(std::bit_cast<std::uint32_t>(t[0].w), l == 0 ? 0u : 2u) << "a triangle of another shape";
            areas.push_back(0.5 * glm::length(glm::cross(glm::dvec3(t[1]) - glm::dvec3(t[0]),
                                                         glm::dvec3(t[2]) - glm::dvec3(t[0]))));
        }
        expectChosenByArea(compiled, light, areas);
    }
}

TEST(CompiledLights, SecondEnvironmentAndTooManyLightsAreRefused) {
    SceneDescription description = scene();
    description.emitters = {emitter(kConstant, {1, 1, 1}), emitter(kConstant, {1, 1, 1})};
    EXPECT_TRUE(contains(inputErrorOf(description), "lights.xml:2:2: a scene may have one emitter that surrounds it"));
    description.emitters.assign(shared::kMaxLights, emitter(kPoint, {1, 1, 1}));
    EXPECT_EQ(inputErrorOf(description), "");
    description.emitters.push_back(emitter(kPoint, {1, 1, 1}));
    EXPECT_TRUE(contains(inputErrorOf(description), "at most 256 lights"));
    description.emitters = {emitter(kPoint, glm::dvec3(1e39))};
    EXPECT_TRUE(contains(inputErrorOf(description), "single precision"));
}

TEST(CompiledLights, AMeshOfZeroAreaEmitsNothing) {
    SceneDescription description = scene();
    description.shapes = {emissive(tetrahedron("t"), {1, 1, 1})};
    description.shapes[0].mesh.triangles = {{0, 1, 1}};
    EXPECT_EQ(compileScene(description).constants.lightCount, 0u);
}

}  // namespace
}  // namespace parhelion
