// What a scene in Nori's dialect means: defaults, transforms, and every plugin's properties.
#include <gtest/gtest.h>

#include <numbers>

#include "support/nori_text.h"

namespace parhelion::test {
namespace {

SceneDescription readCamera(const std::string& content) {
    return readText(noriSceneOf("", kNoriIntegrator + "<camera type=\"perspective\">" + content + "</camera>"));
}

IntegratorDescription readIntegrator(const std::string& type, const std::string& content = "") {
    return readText(noriSceneOf("", "<integrator type=\"" + type + "\">" + content + "</integrator>" + kNoriCamera))
        .integrator;
}

ShapeDescription readRectangle(const std::string& content) {
    return readNori("<mesh type=\"rectangle\">" + content + "</mesh>").shapes.at(0);
}

TEST(NoriDefaults, AreNoris) {
    const SceneDescription scene = readNori(R"(<mesh type="rectangle"/>)");
    EXPECT_EQ(scene.film.size, glm::uvec2(1280, 720));
    EXPECT_EQ(scene.film.filter, ReconstructionFilter::Gaussian);
    EXPECT_EQ(scene.film.filterStddev, 0.5);
    EXPECT_EQ(scene.film.filterRadius, 2.0);
    EXPECT_EQ(scene.camera.fovDegrees, 30.0);
    EXPECT_EQ(scene.camera.toWorld, glm::dmat4(1.0));
    EXPECT_EQ(scene.sampleCount, 1u);
    EXPECT_EQ(scene.integrator.maxDepth, -1);
    EXPECT_EQ(scene.shapes.at(0).bsdf.reflectance, glm::dvec3(0.5));
    EXPECT_TRUE(scene.notes.empty());
}

TEST(NoriDialect, IsToldApartByCameraOrMeshWithoutAVersion) {
    EXPECT_EQ(readText("<scene>" + kNoriCamera + kNoriIntegrator + "</scene>").film.size.x, 1280u);
    EXPECT_EQ(readText(sceneOf("")).film.size.x, 768u);
}

TEST(NoriCamera, HoldsFilmAndFilter) {
    const SceneDescription scene = readCamera(
        R"(<integer name="width" value="40"/><integer name="height" value="30"/><float name="fov" value="50"/>
<float name="nearClip" value="0.1"/><float name="farClip" value="100"/>
<rfilter type="gaussian"><float name="radius" value="1.5"/><float name="stddev" value="0.4"/></rfilter>)");
    EXPECT_EQ(scene.film.size, glm::uvec2(40, 30));
    EXPECT_EQ(scene.camera.fovDegrees, 50.0);
    EXPECT_EQ(scene.film.filterRadius, 1.5);
    EXPECT_EQ(scene.film.filterStddev, 0.4);
    EXPECT_EQ(scene.notes.size(), 2u) << "the clipping planes";
    EXPECT_EQ(readCamera(R"(<rfilter type="box"/>)").film.filter, ReconstructionFilter::Box);
    EXPECT_EQ(readCamera(R"(<rfilter type="box"/>)").film.filterRadius, 0.5);
    EXPECT_EQ(readCamera(R"(<rfilter type="tent"/>)").film.filter, ReconstructionFilter::Tent);
    EXPECT_EQ(readCamera(R"(<rfilter type="tent"/>)").film.filterRadius, 1.0);
}

TEST(NoriSampler, GivesSampleCountAndSeed) {
    const SceneDescription scene = readNori(
        R"(<sampler type="independent"><integer name="sampleCount" value="77"/><integer name="seed" value="5"/></sampler>)");
    EXPECT_EQ(scene.sampleCount, 77u);
    EXPECT_EQ(scene.seed, 5u);
}

TEST(NoriTransform, StepsAreMultipliedFromTheLeft) {
    // As Nori: transform = step * transform. (1, 0, 0) is scaled to 2, turned to (0, 2, 0), moved to (0, 2, 5).
    const glm::dmat4 transform = readRectangle(R"(<transform name="toWorld"><scale value="2 2 2"/>
<rotate axis="0, 0, 1" angle="90"/><translate value="0,0,5"/></transform>)")
                                     .toWorld;
    expectNear(moved(transform, {1, 0, 0}), {0, 2, 5});
}

TEST(NoriTransform, MatricesAreGivenRowByRow) {
    const glm::dmat4 transform =
        readRectangle(R"(<transform name="toWorld"><matrix value="0 -1 0 4  1 0 0 5  0 0 1 6  0 0 0 1"/></transform>)")
            .toWorld;
    expectNear(moved(transform, {1, 0, 0}), {4, 6, 6});
}

TEST(NoriTransform, LookatPutsXToTheLeft) {
    const glm::dmat4 camera = readCamera(R"(<transform name="toWorld">
<lookat origin="1, 2, 3" target="1, 2, -7" up="0 1 0"/></transform>)")
                                  .camera.toWorld;
    expectNear(moved(camera, {0, 0, 1}), {1, 2, 2});
    expectNear(moved(camera, {1, 0, 0}), {0, 2, 3});  // left = up x direction = (-1, 0, 0)
}

TEST(NoriMesh, ObjKeepsItsTextureCoordinatesAndIsFlatWithoutNormals) {
    const SceneDescription scene =
        readText(noriSceneOf(R"(<mesh type="obj"><string name="filename" value="t.obj"/></mesh>)"), {},
                 {{"t.obj", kTriangleObj}});
    const Mesh& mesh = scene.shapes.at(0).mesh;
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.uvs.at(0), glm::dvec2(0, 0.25));
    EXPECT_TRUE(mesh.normals.empty());
}

TEST(NoriMesh, SphereHasCenterAndRadius) {
    const ShapeDescription sphere =
        readNori(R"(<mesh type="sphere"><point name="center" value="1 2 3"/><float name="radius" value="0.5"/></mesh>)")
            .shapes.at(0);
    EXPECT_EQ(sphere.type, ShapeDescription::Type::Sphere);
    EXPECT_EQ(sphere.center, glm::dvec3(1, 2, 3));
    EXPECT_EQ(sphere.radius, 0.5);
}

TEST(NoriBsdf, DiffuseHasAnAlbedo) {
    EXPECT_EQ(
        readRectangle(R"(<bsdf type="diffuse"><color name="albedo" value="0.1 0.2 0.3"/></bsdf>)").bsdf.reflectance,
        glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(readRectangle(R"(<bsdf type="null"/>)").bsdf.type, BsdfDescription::Type::Null);
}

TEST(NoriBsdf, TexturedDiffuseTurnsVOverBeforeItScales) {
    const std::string text = noriSceneOf(R"(<mesh type="rectangle"><bsdf type="textured_diffuse">
<string name="filename" value="pair.hdr"/><float name="uScale" value="4"/><float name="v_scale" value="2"/>
<boolean name="flipV" value="true"/><boolean name="repeat" value="false"/><color name="tint" value="1 0.5 0"/>
</bsdf></mesh>)");
    const SceneDescription scene = readText(text, {}, {{"pair.hdr", kPairHdr}});
    const BsdfDescription& bsdf = scene.shapes.at(0).bsdf;
    EXPECT_EQ(bsdf.reflectance, glm::dvec3(1, 0.5, 0));
    const TextureDescription& texture = scene.textures.at(bsdf.texture.value());
    EXPECT_EQ(texture.wrap, TextureDescription::Wrap::Clamp);
    EXPECT_FALSE(texture.nearest);
    EXPECT_EQ(texture.bitmap.size, glm::uvec2(2, 1));
    EXPECT_EQ(texture.bitmap.at(1, 0), glm::vec3(2, 1, 0.5));
    expectNear(texture.uvTransform * glm::dvec3(0.5, 0.25, 1), {2, 1.5, 1});  // (4 u, 2 (1 - v))
}

TEST(NoriEmitter, AreaLightsHaveTwoSidesUnlessToldOtherwise) {
    const ShapeDescription both =
        readRectangle(R"(<emitter type="area"><color name="radiance" value="1 2 3"/></emitter>)");
    EXPECT_EQ(both.radiance, glm::dvec3(1, 2, 3));
    EXPECT_TRUE(both.emitsOnBothSides);
    EXPECT_EQ(both.bsdf.reflectance, glm::dvec3(0.5)) << "Nori's mesh without a BSDF is diffuse, a light as well";
    EXPECT_FALSE(
        readRectangle(R"(<emitter type="area"><boolean name="twoSided" value="false"/></emitter>)").emitsOnBothSides);
}

TEST(NoriEmitter, MapIsMitsubasTurnedByMinus90DegreesAboutY) {
    const SceneDescription scene =
        readText(noriSceneOf(R"(<emitter type="envmap"><string name="filename" value="pair.hdr"/>
<float name="scale" value="3"/><transform name="toWorld"><rotate axis="1 0 0" angle="90"/></transform></emitter>)"),
                 {}, {{"pair.hdr", kPairHdr}});
    const EmitterDescription& map = scene.emitters.at(0);
    EXPECT_EQ(map.type, EmitterDescription::Type::EnvironmentMap);
    EXPECT_EQ(map.value, glm::dvec3(3));
    EXPECT_EQ(map.map.size, glm::uvec2(2, 1));
    // The middle of Mitsuba's map is its +z; -90 degrees about +y bring that to -x, which the author's rotation keeps.
    expectNear(moved(map.toWorld, {0, 0, 1}), {-1, 0, 0});
    expectNear(moved(map.toWorld, {0, 1, 0}), {0, 0, 1});
}

TEST(NoriEmitter, InfiniteIsAGradientWithStars) {
    const SceneDescription scene = readNori(R"(<emitter type="infinite"><vector name="axis" value="0 0 2"/>
<float name="offset" value="0.1"/><float name="width" value="0.5"/><float name="power" value="2"/>
<color name="top" value="1 2 3"/><color name="bottom" value="4 5 6"/><float name="starDensity" value="20"/>
<float name="starSize" value="0.2"/><color name="starBrightness" value="7 8 9"/><integer name="starSeed" value="3"/>
</emitter>)");
    const EmitterDescription& emitter = scene.emitters.at(0);
    const SkyDescription& sky = emitter.sky;
    EXPECT_EQ(emitter.type, EmitterDescription::Type::Sky);
    EXPECT_EQ(sky.axis, glm::dvec3(0, 0, 1));
    EXPECT_EQ(sky.offset, 0.1);
    EXPECT_EQ(sky.width, 0.5);
    EXPECT_EQ(sky.power, 2.0);
    EXPECT_EQ(sky.top, glm::dvec3(1, 2, 3));
    EXPECT_EQ(sky.bottom, glm::dvec3(4, 5, 6));
    EXPECT_EQ(sky.starDensity, 20.0);
    EXPECT_EQ(sky.starSizeDegrees, 0.2);
    EXPECT_EQ(sky.starRadiance, glm::dvec3(7, 8, 9));
    EXPECT_EQ(sky.starSeed, 3u);
}

TEST(NoriEmitter, DirectionalAndPointLightsHaveTheirLaws) {
    const SceneDescription scene = readNori(R"(<emitter type="directional"><vector name="direction" value="0 -2 0"/>
<color name="radiance" value="1 2 3"/></emitter>
<emitter type="point"><point name="position" value="1 2 3"/><float name="power" value="12"/></emitter>)");
    EXPECT_EQ(scene.emitters.at(0).vector, glm::dvec3(0, -1, 0));
    EXPECT_EQ(scene.emitters.at(0).value, glm::dvec3(1, 2, 3));
    EXPECT_EQ(scene.emitters.at(1).vector, glm::dvec3(1, 2, 3));
    expectNear(scene.emitters.at(1).value, glm::dvec3(3 / std::numbers::pi));
}

TEST(NoriIntegrator, DirectTakesItsStrategy) {
    struct Case {
        const char *type, *strategy;
        double emitterSamples, scatterSamples;
    };
    for (const Case& given : {Case{"direct", "mis", 1, 1}, Case{"direct", "bsdf", 0, 1},
                              Case{"direct", "emitter", 1, 0}, Case{"direct", "", 1, 1}, Case{"direct_mats", "", 0, 1},
                              Case{"direct_ems", "", 1, 0}, Case{"direct_mis", "", 1, 1}}) {
        const std::string strategy(given.strategy);
        const IntegratorDescription integrator = readIntegrator(
            given.type, strategy.empty() ? "" : "<string name=\"strategy\" value=\"" + strategy + "\"/>");
        EXPECT_EQ(integrator.type, "direct");
        EXPECT_EQ(integrator.maxDepth, 2);
        EXPECT_EQ(integrator.emitterSamples, given.emitterSamples) << given.type << " " << strategy;
        EXPECT_EQ(integrator.scatterSamples, given.scatterSamples) << given.type << " " << strategy;
    }
}

TEST(NoriIntegrator, PathsHaveNoDepthLimitUnlessAsked) {
    EXPECT_EQ(readIntegrator("path_mis").type, "path");
    EXPECT_EQ(readIntegrator("path_mis_vol").type, "volpath");
    EXPECT_EQ(readIntegrator("path_mis_vol").maxDepth, -1);
    EXPECT_EQ(readIntegrator("path_mis", R"(<integer name="maxDepth" value="4"/>)").maxDepth, 4);
    EXPECT_EQ(readIntegrator("path_mis", R"(<integer name="rr_depth" value="9"/>)").rouletteDepth, 9);
}

}  // namespace
}  // namespace parhelion::test
