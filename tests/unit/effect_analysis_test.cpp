#include <gtest/gtest.h>

#include "unit/compile_fixtures.h"

namespace parhelion {
namespace {

using namespace fixtures;

struct Case {
    const char* name;
    SceneDescription description;
    std::vector<Effect> expected;  // every other effect must be off
};

SceneDescription with(std::vector<ShapeDescription> shapes, std::vector<MediumDescription> media = {},
                      std::vector<EmitterDescription> emitters = {}) {
    SceneDescription description = scene();
    description.shapes = std::move(shapes);
    description.media = std::move(media);
    description.emitters = std::move(emitters);
    return description;
}

EmitterDescription light(EmitterDescription::Type type) {
    EmitterDescription result;
    result.type = type;
    return result;
}

ShapeDescription twoSided(ShapeDescription shape) {
    shape.bsdf.twoSided = true;
    return shape;
}

ShapeDescription bothSides(ShapeDescription shape) {
    shape.emitsOnBothSides = true;
    return shape;
}

std::vector<Case> surfaceCases() {
    ShapeDescription smooth = tetrahedron("t");
    smooth.mesh.normals.assign(4, {0, 0, 1});
    SceneDescription limited = scene(), filtered = scene();
    limited.integrator.maxDepth = 5;
    filtered.film.filter = ReconstructionFilter::Tent;
    const glm::dvec3 white(1, 1, 1);
    using enum Effect;
    return {{"nothing", scene(), {}},
            {"quad", with({rectangle("r")}), {hasSurfaces, hasQuads}},
            {"two-sided quad", with({twoSided(rectangle("r"))}), {hasSurfaces, hasQuads, hasDoubleSided}},
            {"sphere", with({sphere("s", {}, 1)}), {hasSurfaces, hasSpheres}},
            {"box", with({cube("c", {}, white)}), {hasSurfaces, hasBoxes}},
            {"mesh", with({tetrahedron("t")}), {hasSurfaces, hasTriangles}},
            {"smooth mesh", with({smooth}), {hasSurfaces, hasTriangles, hasVertexNormals}},
            {"depth limit", limited, {hasDepthLimit}},
            {"filter", filtered, {hasFilterTable}},
            {"area light", with({emissive(rectangle("r"), white)}), {hasSurfaces, hasQuads, hasAreaLights}},
            {"two-sided light",
             with({bothSides(emissive(rectangle("r"), white))}),
             {hasSurfaces, hasQuads, hasAreaLights, hasTwoSidedLights}},
            {"two lights",
             with({emissive(rectangle("r"), white)}, {}, {light(EmitterDescription::Type::Point)}),
             {hasSurfaces, hasQuads, hasAreaLights, hasDeltaLights, hasManyLights}},
            {"sun", with({}, {}, {light(EmitterDescription::Type::Directional)}), {hasDeltaLights}},
            {"sky", with({}, {}, {light(EmitterDescription::Type::Constant)}), {hasEnvironment}}};
}

std::vector<Case> mediumCases() {
    const glm::dvec3 unit(1, 1, 1);
    MediumDescription chromatic = medium("m"), forward = medium("m"), patterned = medium("m"), weightless = medium("m");
    chromatic.sigmaT = {1, 2, 3};
    forward.phase.type = PhaseDescription::Type::HenyeyGreenstein;
    forward.phase.g = 0.5;
    MediumDescription twoLobes = forward, air = medium("m"), droplets = medium("m");
    twoLobes.phase.type = PhaseDescription::Type::DualHenyeyGreenstein;
    twoLobes.phase.lobeWeight = 0.5;
    air.phase.type = PhaseDescription::Type::Rayleigh;
    droplets.phase.type = PhaseDescription::Type::Tabulated;
    droplets.phase.table = {1, 2};
    patterned.albedoGrid = GridPlacement{};
    patterned.albedoGrid->volume.density = DensityGrid::fromDense({2, 1, 1}, std::vector<float>{0.5f, 1.0f});
    weightless.sigmaT = glm::dvec3(0.0);
    const MediumDescription grid = gridMedium("m", DensityGrid::fromDense({2, 1, 1}, std::vector<float>{0.5f, 1.0f}));
    const ShapeDescription box = boundary(cube("c", {}, unit), 0);
    using enum Effect;
    return {
        {"fog", with({box}, {medium("m")}), {hasBoxes, hasMedia, hasHomogeneousMedia}},
        {"cloud", with({box}, {grid}), {hasBoxes, hasMedia, hasHeterogeneousMedia}},
        {"chromatic fog", with({box}, {chromatic}), {hasBoxes, hasMedia, hasHomogeneousMedia, hasChromaticExtinction}},
        {"forward fog", with({box}, {forward}), {hasBoxes, hasMedia, hasHomogeneousMedia, hasHenyeyGreenstein}},
        {"two lobes", with({box}, {twoLobes}), {hasBoxes, hasMedia, hasHomogeneousMedia, hasDualHenyeyGreenstein}},
        {"air", with({box}, {air}), {hasBoxes, hasMedia, hasHomogeneousMedia, hasRayleigh}},
        {"droplets", with({box}, {droplets}), {hasBoxes, hasMedia, hasHomogeneousMedia, hasTabulatedPhase}},
        {"patterned fog", with({box}, {patterned}), {hasBoxes, hasMedia, hasHomogeneousMedia, hasAlbedoGrids}},
        {"weightless fog", with({box}, {weightless}), {}},
        {"fog and cloud",
         with({box, boundary(sphere("s", {5, 0, 0}, 1), 1)}, {medium("m"), grid}),
         {hasBoxes, hasSpheres, hasMedia, hasManyMedia, hasHomogeneousMedia, hasHeterogeneousMedia}}};
}

void check(const Case& given) {
    const EffectSet effects = compileScene(given.description).effects;
    std::bitset<kEffectCount> expected;
    for (const Effect effect : given.expected) expected.set(static_cast<unsigned>(effect));
    for (unsigned i = 0; i < kEffectCount; ++i) {
        EXPECT_EQ(effects.on[i], expected[i]) << given.name << ", effect " << i << ": " << effects.reasons[i];
        EXPECT_TRUE(effects.reasons[i].starts_with(effects.on[i] ? "yes: " : "no: ")) << effects.reasons[i];
    }
}

TEST(EffectAnalysis, SurfacesAndLightsSwitchTheirEffectsOn) {
    for (const Case& given : surfaceCases()) check(given);
}

TEST(EffectAnalysis, MediaSwitchTheirEffectsOn) {
    for (const Case& given : mediumCases()) check(given);
}

TEST(EffectAnalysis, SampledEnvironmentIsAnEffectOfItsOwn) {
    CompileOptions options;
    options.sampleEveryLight = true;
    const EffectSet effects =
        compileScene(with({sphere("s", {}, 1)}, {}, {light(EmitterDescription::Type::Constant)}), options).effects;
    EXPECT_TRUE(effects.has(Effect::hasEnvironmentSampling));
    EXPECT_FALSE(effects.has(Effect::hasManyLights));
}

TEST(EffectAnalysis, ReasonsReadLikeSentences) {
    const EffectSet effects = compileScene(with({emissive(rectangle("a"), {1, 1, 1}), rectangle("b")})).effects;
    EXPECT_EQ(effects.reasons[static_cast<unsigned>(Effect::hasAreaLights)], "yes: 1 area light");
    EXPECT_EQ(effects.reasons[static_cast<unsigned>(Effect::hasQuads)], "yes: 2 parallelograms");
    EXPECT_EQ(effects.reasons[static_cast<unsigned>(Effect::hasChromaticExtinction)], "no: every extinction is grey");
}

TEST(EffectSet, AllHasEveryEffect) { EXPECT_TRUE(EffectSet::all().on.all()); }

}  // namespace
}  // namespace parhelion
