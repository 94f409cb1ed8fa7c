// What a scene file means: defaults and every supported plugin's properties.
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
    EXPECT_NEAR(scene.camera.fovDegrees, 46.7930, 5e-5);  // of 50 mm
    EXPECT_EQ(scene.camera.fovAxis, FovAxis::Diagonal);
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

// Mitsuba 3.9.1's llvm_ad_rgb: the light of a constant spectrum has the colour of equal energy; all else is grey.
TEST(SceneColor, OfASpectrumIsThatOfEqualEnergyInEmittersAlone) {
    const glm::dvec3 equalEnergy(1.2047938, 0.9482910, 0.9089161);
    constexpr double kPrinted = 2e-7;  // single precision, seven digits
    const SceneDescription scene =
        readText(sceneOf(R"(<emitter type="constant"><spectrum name="radiance" value="1"/></emitter>
<emitter type="point"><spectrum name="intensity" value="1"/></emitter>
<emitter type="directional"><spectrum name="irradiance" value="1"/></emitter>
<shape type="cube"><emitter type="area"><spectrum name="radiance" value="1"/></emitter></shape>
<shape type="cube"><bsdf type="diffuse"><spectrum name="reflectance" value="0.25"/></bsdf>
<emitter type="area"><float name="radiance" value="1"/></emitter></shape>)"));
    for (const EmitterDescription& emitter : scene.emitters)
        EXPECT_LT(glm::length(emitter.value - equalEnergy), kPrinted);
    EXPECT_LT(glm::length(*scene.shapes.at(0).radiance - equalEnergy), kPrinted);
    EXPECT_EQ(scene.shapes.at(1).radiance, glm::dvec3(1.0));
    EXPECT_EQ(scene.shapes.at(1).bsdf.reflectance, glm::dvec3(0.25));
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

TEST(SceneFilm, TakesMitsubasFormatsInAnyCase) {
    const SceneDescription scene = readText(sceneOf("", kIntegrator + R"(<sensor type="perspective">
<float name="fov" value="40"/><string name="fov_axis" value="Smaller"/>
<float name="shutter_open" value="0"/><float name="shutter_close" value="1"/>
<film type="hdrfilm"><string name="file_format" value="PFM"/><string name="pixel_format" value="Luminance_Alpha"/>
<string name="component_format" value="FLOAT32"/><boolean name="banner" value="false"/></film></sensor>)"));
    EXPECT_EQ(scene.camera.fovAxis, FovAxis::Smaller);
    EXPECT_EQ(scene.notes.size(), 5u) << "file and pixel format, banner, both ends of the shutter";
}

TEST(SceneNotes, TellWhatMitsubaAcceptsToo) {
    const SceneDescription scene = readText(sceneOf(R"(<medium type="homogeneous" id="fog"/>
<shape type="sphere"><emitter type="area"><ref id="fog"/></emitter></shape>
<emitter type="point"><medium type="homogeneous"/></emitter>
<shape type="cube"><bsdf type="null"/><medium type="homogeneous" name="interior"><volume type="constvolume" name="sigma_t">
<transform name="to_world"><scale value="2"/></transform></volume></medium></shape>)",
                                                    R"(<integrator type="volpathmis">
<boolean name="use_spectral_mis" value="false"/></integrator>)" +
                                                        kSensor));
    EXPECT_EQ(scene.media.size(), 1u);
    EXPECT_EQ(scene.notes.size(), 5u) << "two media of emitters, one of which nothing uses, to_world, use_spectral_mis";
}

TEST(SceneSensor, MayNameItsMedium) {
    const SceneDescription scene =
        readText(sceneOf(R"(<medium type="homogeneous" id="fog"/>
<shape type="cube"><bsdf type="null"/><ref id="fog" name="interior"/></shape>)",
                         kIntegrator + R"(<sensor type="perspective"><ref id="fog"/></sensor>)"));
    ASSERT_EQ(scene.media.size(), 1u);
    EXPECT_EQ(scene.camera.medium, scene.shapes.at(0).interior);
    EXPECT_TRUE(scene.notes.empty());
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
