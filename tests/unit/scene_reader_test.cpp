// What a scene file means: defaults, directives, and every supported plugin's properties.
#include <gtest/gtest.h>

#include "support/scene_reading.h"

namespace parhelion::test {
namespace {

ShapeDescription readShapeText(const std::string& shape) { return readText(sceneOf(shape)).shapes.at(0); }

SceneDescription readMediumText(const std::string& medium) {
    return readText(sceneOf("<shape type=\"cube\"><bsdf type=\"null\"/>" + medium + "</shape>"));
}

TEST(SceneDefaults, AreMitsubas) {
    // Read from Mitsuba 3.9.1's objects.
    const SceneDescription scene =
        readText(sceneOf(R"(<emitter type="constant"/><emitter type="point"/><emitter type="directional"/>
<shape type="sphere"><bsdf type="null"/><medium type="homogeneous" name="interior"><phase type="hg"/></medium></shape>
<shape type="rectangle"/><shape type="cube"><emitter type="area"/></shape>)"));
    EXPECT_EQ(scene.film.size, glm::uvec2(768, 576));
    EXPECT_EQ(scene.film.filter, ReconstructionFilter::Gaussian);
    EXPECT_EQ(scene.film.filterStddev, 0.5);
    EXPECT_EQ(scene.film.filterRadius, 2.0);
    EXPECT_EQ(scene.sampleCount, 4u);
    EXPECT_EQ(scene.seed, 0u);
    EXPECT_NEAR(scene.camera.fovXDegrees, 38.1848, 5e-5);  // 50 mm at 4:3; printed with four decimals
    EXPECT_EQ(scene.integrator.maxDepth, -1);
    EXPECT_EQ(scene.integrator.rouletteDepth, 5);
    EXPECT_EQ(scene.media.at(0).sigmaT, glm::dvec3(1.0));
    EXPECT_EQ(scene.media.at(0).albedo, glm::dvec3(0.75));
    EXPECT_EQ(scene.media.at(0).phase.g, 0.8);
    for (const EmitterDescription& emitter : scene.emitters) EXPECT_EQ(emitter.value, glm::dvec3(1.0));
    EXPECT_EQ(scene.emitters.at(1).vector, glm::dvec3(0.0));
    EXPECT_EQ(scene.emitters.at(2).vector, glm::dvec3(0.0, 0.0, 1.0));
    EXPECT_EQ(scene.shapes.at(0).radius, 1.0);
    EXPECT_EQ(scene.shapes.at(1).bsdf.reflectance, glm::dvec3(0.5));
    EXPECT_EQ(scene.shapes.at(2).radiance, glm::dvec3(1.0));
    EXPECT_EQ(scene.shapes.at(2).bsdf.reflectance, glm::dvec3(0.0)) << "a light without a BSDF is black";
}

TEST(SceneDefaults, MediumWithoutPhaseFunctionIsIsotropic) {
    const SceneDescription scene = readMediumText(R"(<medium type="homogeneous" name="interior"/>)");
    EXPECT_EQ(scene.media.at(0).phase.type, PhaseDescription::Type::Isotropic);
}

TEST(SceneEmitters, AreaLightsHaveOneSideUnlessToldOtherwise) {
    EXPECT_FALSE(readShapeText(R"(<shape type="cube"><emitter type="area"/></shape>)").emitsOnBothSides);
    EXPECT_TRUE(readShapeText(R"(<shape type="cube"><emitter type="area">
<boolean name="two_sided" value="true"/></emitter></shape>)")
                    .emitsOnBothSides);
}

TEST(SceneVariables, ReplaceNamesAndYieldToDefines) {
    const std::string text = sceneOf(R"(<default name="r" value="2"/><default name="r2" value="3"/>
<shape type="sphere"><float name="radius" value="$r"/></shape>
<shape type="sphere"><float name="radius" value="$r2.5"/></shape>)");
    EXPECT_EQ(readText(text).shapes.at(0).radius, 2.0);
    EXPECT_EQ(readText(text).shapes.at(1).radius, 3.5) << "the longest name wins";
    EXPECT_EQ(readText(text, {.defines = {{"r", "7"}}}).shapes.at(0).radius, 7.0);
}

TEST(SceneVariables, FirstDefaultWinsAsInMitsuba) {
    EXPECT_EQ(readText(sceneOf(R"(<default name="r" value="2"/><default name="r" value="3"/>
<shape type="sphere"><float name="radius" value="$r"/></shape>)"))
                  .shapes.at(0)
                  .radius,
              2.0);
}

TEST(SceneVariables, DefineThatNothingUsesIsRefused) {
    try {
        readText(sceneOf(R"(<default name="spp" value="2"/>)"), {.defines = {{"sp", "4"}}});
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean \"spp\"?"), std::string::npos) << error.what();
    }
}

TEST(SceneInclude, SplicesScenesAndSingleObjectsAndSharesVariables) {
    const SceneDescription scene =
        readText(sceneOf(R"(<default name="r" value="2"/><include filename="parts/a.xml"/><shape type="sphere">
<include filename="parts/white.xml"/></shape>)"),
                 {},
                 {{"parts/a.xml", R"(<scene version="3.0.0"><include filename="b.xml"/></scene>)"},
                  {"parts/b.xml",
                   R"(<scene version="3.0.0"><shape type="sphere"><float name="radius" value="$r"/></shape></scene>)"},
                  {"parts/white.xml", R"(<bsdf type="diffuse"><float name="reflectance" value="0.9"/></bsdf>)"}});
    ASSERT_EQ(scene.shapes.size(), 2u);
    EXPECT_EQ(scene.shapes[0].radius, 2.0);
    EXPECT_EQ(scene.shapes[1].bsdf.reflectance, glm::dvec3(0.9));
}

TEST(ScenePath, AddsFoldersToTheSearch) {
    const SceneDescription scene =
        readText(sceneOf(R"(<path value="assets"/><include filename="ball.xml"/>)"), {},
                 {{"assets/ball.xml", R"(<scene version="3.0.0"><shape type="sphere"/></scene>)"}});
    EXPECT_EQ(scene.shapes.size(), 1u);
}

TEST(SceneReferences, ResolveForwardsAndThroughAliases) {
    const SceneDescription scene = readText(sceneOf(R"(<shape type="sphere"><ref id="paint"/></shape>
<bsdf type="diffuse" id="white"><float name="reflectance" value="0.9"/></bsdf><alias id="white" as="paint"/>
<shape type="cube"><bsdf type="null"/><ref id="fog" name="interior"/></shape>
<shape type="cube"><bsdf type="null"/><ref id="fog" name="interior"/><ref id="air" name="exterior"/></shape>
<medium type="homogeneous" id="fog"/><medium type="homogeneous" id="air"/>)"));
    EXPECT_EQ(scene.shapes.at(0).bsdf.reflectance, glm::dvec3(0.9));
    ASSERT_EQ(scene.media.size(), 2u) << "a shared medium is one medium";
    EXPECT_EQ(scene.shapes.at(1).interior, scene.shapes.at(2).interior);
    EXPECT_EQ(scene.media.at(*scene.shapes.at(2).exterior).id, "air");
}

TEST(SceneReferences, UnusedMediumIsCheckedAndNotedButNotKept) {
    const SceneDescription scene = readText(sceneOf(R"(<medium type="homogeneous" id="fog"/>)"));
    EXPECT_TRUE(scene.media.empty());
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_NE(scene.notes[0].find("scene.xml:2:1: the medium is used by no shape"), std::string::npos)
        << scene.notes[0];
}

TEST(SceneVersion, BelowTwoHasCamelCaseNames) {
    const SceneDescription scene = readText(R"(<scene version="0.6.0"><integrator type="volpath">
<integer name="maxDepth" value="7"/></integrator><sensor type="perspective"><transform name="toWorld">
<lookAt origin="0,0,4" target="0,0,0" up="0,1,0"/></transform></sensor></scene>)");
    EXPECT_EQ(scene.integrator.maxDepth, 7);
    EXPECT_EQ(glm::dvec3(scene.camera.toWorld[3]), glm::dvec3(0, 0, 4));
}

TEST(SceneColor, HasFourForms) {
    const auto reflectance = [](const std::string& value) {
        return readShapeText("<shape type=\"sphere\"><bsdf type=\"diffuse\">" + value + "</bsdf></shape>")
            .bsdf.reflectance;
    };
    EXPECT_EQ(reflectance(R"(<rgb name="reflectance" value="0.1, 0.2 0.3"/>)"), glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(reflectance(R"(<rgb name="reflectance" value="0.25"/>)"), glm::dvec3(0.25));
    EXPECT_EQ(reflectance(R"(<float name="reflectance" value="0.25"/>)"), glm::dvec3(0.25));
    EXPECT_EQ(reflectance(R"(<spectrum name="reflectance" value="0.25"/>)"), glm::dvec3(0.25));
    // sRGB: 0x80 / 255 = 0.50196 encodes ((0.50196 + 0.055) / 1.055)^2.4 = 0.2158605.
    const glm::dvec3 hex = reflectance(R"(<rgb name="reflectance" value="#ff0080"/>)");
    EXPECT_NEAR(hex.r, 1.0, 1e-12);
    EXPECT_EQ(hex.g, 0.0);
    EXPECT_NEAR(hex.b, 0.2158605, 5e-8);
}

TEST(SceneFilm, ReadsSizeCropAndFilters) {
    const auto film = [](const std::string& content) {
        return readText(sceneOf("", kIntegrator + "<sensor type=\"perspective\"><film type=\"hdrfilm\">" + content +
                                        "</film></sensor>"))
            .film;
    };
    const FilmDescription cropped = film(R"(<integer name="width" value="40"/><integer name="height" value="30"/>
<integer name="crop_offset_x" value="8"/><integer name="crop_offset_y" value="4"/>
<integer name="crop_width" value="32"/><integer name="crop_height" value="16"/><rfilter type="box"/>)");
    EXPECT_EQ(cropped.size, glm::uvec2(40, 30));
    EXPECT_EQ(cropped.cropOffset, glm::uvec2(8, 4));
    EXPECT_EQ(cropped.cropSize, glm::uvec2(32, 16));
    EXPECT_EQ(cropped.filter, ReconstructionFilter::Box);
    EXPECT_EQ(cropped.filterRadius, 0.5);
    EXPECT_FALSE(film("").cropSize.has_value());
    EXPECT_EQ(film(R"(<rfilter type="tent"/>)").filterRadius, 1.0);
    EXPECT_EQ(film(R"(<rfilter type="tent"><float name="radius" value="1.5"/></rfilter>)").filterRadius, 1.5);
    const FilmDescription wide = film(R"(<rfilter type="gaussian"><float name="stddev" value="0.75"/></rfilter>)");
    EXPECT_EQ(wide.filterStddev, 0.75);
    EXPECT_EQ(wide.filterRadius, 3.0);
}

TEST(SceneSensor, NotesWhatHasNoEffect) {
    const SceneDescription scene = readText(sceneOf("", kIntegrator + R"(<sensor type="perspective">
<float name="near_clip" value="1"/><float name="principal_point_offset_x" value="0.1"/>
<sampler type="stratified"><integer name="sample_count" value="9"/><integer name="seed" value="3"/></sampler></sensor>)"));
    EXPECT_EQ(scene.sampleCount, 9u);
    EXPECT_EQ(scene.seed, 3u);
    EXPECT_EQ(scene.camera.principalPointOffset, glm::dvec2(0.1, 0.0));
    EXPECT_EQ(scene.notes.size(), 2u) << "near_clip and the sampler";
}

TEST(SceneIntegrator, IsUnwrappedFromMoment) {
    const SceneDescription scene = readText(sceneOf("", R"(<integrator type="moment"><integrator type="volpathmis">
<integer name="max_depth" value="16"/><integer name="rr_depth" value="9"/></integrator></integrator>)" +
                                                            kSensor));
    EXPECT_EQ(scene.integrator.type, "volpath");
    EXPECT_EQ(scene.integrator.maxDepth, 16);
    EXPECT_EQ(scene.integrator.rouletteDepth, 9);
}

TEST(SceneShape, ReadsItsParts) {
    const ShapeDescription sphere = readShapeText(R"(<shape type="sphere" id="ball">
<point name="center" x="1" y="2" z="3"/><float name="radius" value="0.5"/><boolean name="flip_normals" value="true"/>
<transform name="to_world"><scale value="2"/></transform>
<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.1, 0.2, 0.3"/></bsdf></bsdf></shape>)");
    EXPECT_EQ(sphere.id, "ball");
    EXPECT_EQ(sphere.type, ShapeDescription::Type::Sphere);
    EXPECT_EQ(sphere.center, glm::dvec3(1, 2, 3));
    EXPECT_EQ(sphere.radius, 0.5);
    EXPECT_EQ(sphere.toWorld[0][0], 2.0) << "the centre and radius stay as written; toWorld comes after";
    EXPECT_TRUE(sphere.flipNormals);
    EXPECT_TRUE(sphere.bsdf.twoSided);
    EXPECT_EQ(sphere.bsdf.reflectance, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(sphere.where.line, 2);
}

TEST(SceneEmitters, TakeDirectionsPositionsAndTransforms) {
    const SceneDescription scene = readText(sceneOf(R"(
<emitter type="directional"><vector name="direction" x="3" y="0" z="-4"/><rgb name="irradiance" value="6, 5, 4"/></emitter>
<emitter type="directional"><transform name="to_world"><rotate y="1" angle="90"/></transform></emitter>
<emitter type="point"><point name="position" value="1, 2, 3"/><float name="intensity" value="20"/></emitter>
<emitter type="point"><transform name="to_world"><translate x="5"/></transform></emitter>)"));
    EXPECT_EQ(scene.emitters.at(0).vector, glm::dvec3(0.6, 0.0, -0.8));
    EXPECT_EQ(scene.emitters.at(0).value, glm::dvec3(6, 5, 4));
    EXPECT_NEAR(scene.emitters.at(1).vector.x, 1.0, 1e-15) << "+z is turned to +x";
    EXPECT_EQ(scene.emitters.at(2).vector, glm::dvec3(1, 2, 3));
    EXPECT_EQ(scene.emitters.at(2).value, glm::dvec3(20.0));
    EXPECT_EQ(scene.emitters.at(3).vector, glm::dvec3(5, 0, 0));
}

TEST(SceneMedium, ScaleMultipliesExtinctionWhichMayExceedOne) {
    const MediumDescription medium =
        readMediumText(R"(<medium type="homogeneous" name="interior"><rgb name="sigma_t" value="4, 2, 1"/>
<float name="scale" value="10"/><rgb name="albedo" value="1, 0.5, 0"/></medium>)")
            .media.at(0);
    EXPECT_EQ(medium.sigmaT, glm::dvec3(40, 20, 10));
    EXPECT_EQ(medium.albedo, glm::dvec3(1, 0.5, 0));
    EXPECT_FALSE(medium.density.has_value());
}

TEST(SceneMedium, ScatteringAndAbsorptionGiveExtinctionAndAlbedo) {
    const MediumDescription medium =
        readMediumText(R"(<medium type="homogeneous" name="interior"><rgb name="sigma_s" value="3, 1, 0"/>
<rgb name="sigma_a" value="1, 1, 0"/></medium>)")
            .media.at(0);
    EXPECT_EQ(medium.sigmaT, glm::dvec3(4, 2, 0));
    EXPECT_EQ(medium.albedo, glm::dvec3(0.75, 0.5, 0)) << "nothing scatters where nothing is";
}

}  // namespace
}  // namespace parhelion::test
