// What a scene file means before its plugins do: variables, includes, search paths, references, versions.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/scene_reading.h"

namespace parhelion::test {
namespace {

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

std::string ballFile(int radius) {
    return fmt::format(
        "<scene version=\"3.0.0\"><shape type=\"sphere\"><float name=\"radius\" "
        "value=\"{}\"/></shape></scene>",
        radius);
}

TEST(SceneInclude, MayNameTheOneObjectOfAFileOfItsOwnVersion) {
    const SceneDescription scene = readText(
        sceneOf(R"(<shape type="sphere"><bsdf type="null"/><include filename="fog.xml" name="interior"/></shape>)"), {},
        {{"fog.xml",
          R"(<medium type="homogeneous" version="0.6.0" name="other"><float name="sigmaT" value="2"/></medium>)"}});
    ASSERT_TRUE(scene.shapes.at(0).interior.has_value());
    EXPECT_EQ(scene.media.at(0).sigmaT, glm::dvec3(2.0));
}

// What Mitsuba 3.9.1 takes for the same files: an including file's own folder first, then its <path>s, the last one
// first, then those of the file that includes it.
TEST(ScenePath, IsSearchedAfterTheIncludingFilesFolderLastFirst) {
    const std::string a = R"(<path value="a"/>)", b = R"(<path value="b"/>)", ball = R"(<include filename="o.xml"/>)";
    const auto radius = [](const std::string& body, const std::map<std::string, std::string>& files) {
        return readText(sceneOf(body), {}, files).shapes.at(0).radius;
    };
    const std::string nested = R"(<include filename="inc/n.xml"/>)", head = R"(<scene version="3.0.0">)";
    EXPECT_EQ(radius(a + b + ball, {{"a/o.xml", ballFile(2)}, {"b/o.xml", ballFile(3)}}), 3.0);
    EXPECT_EQ(radius(a + b + ball, {{"o.xml", ballFile(1)}, {"a/o.xml", ballFile(2)}, {"b/o.xml", ballFile(3)}}), 1.0);
    EXPECT_EQ(
        radius(b + nested,
               {{"b/o.xml", ballFile(3)}, {"inc/a/o.xml", ballFile(5)}, {"inc/n.xml", head + a + ball + "</scene>"}}),
        5.0);
    EXPECT_EQ(radius(b + nested,
                     {{"b/o.xml", ballFile(3)}, {"inc/o.xml", ballFile(4)}, {"inc/n.xml", head + ball + "</scene>"}}),
              4.0);
    EXPECT_THROW(radius(nested + ball, {{"a/o.xml", ballFile(2)}, {"inc/n.xml", head + a + "</scene>"}}), InputError)
        << "the <path> of an included file ends with it";
}

// Files of other kinds are searched when all is read: in every <path> of the main scene, then in its folder.
TEST(ScenePath, ComesBeforeTheScenesFolderForWhatObjectsName) {
    const auto triangle = [](int width) { return fmt::format("v 0 0 0\nv {} 0 0\nv 0 1 0\nf 1 2 3\n", width); };
    const SceneDescription scene = readText(
        sceneOf(
            R"(<shape type="obj"><string name="filename" value="m.obj"/></shape><path value="a"/><path value="b"/>)"),
        {}, {{"m.obj", triangle(1)}, {"a/m.obj", triangle(2)}, {"b/m.obj", triangle(3)}});
    EXPECT_EQ(scene.shapes.at(0).mesh.positions.at(1).x, 3.0);
    ASSERT_EQ(scene.files.size(), 2u);
    EXPECT_EQ(scene.files[0].filename(), "scene.xml");
    EXPECT_EQ(scene.files[1].filename(), "m.obj");
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

TEST(SceneVersion, BelowTwoPlacesTexturesByOffsetAndScale) {
    // Mitsuba 3.9.1 gives to_uv [[3, 0, 0.75], [0, 2, 1], [0, 0, 1]].
    const SceneDescription scene = readText(R"(<scene version="0.6.0"><integrator type="path"/>
<sensor type="perspective"/><shape type="rectangle"><bsdf type="diffuse">
<texture type="checkerboard" name="reflectance"><float name="uoffset" value="0.25"/><float name="uscale" value="3"/>
<float name="vscale" value="2"/><float name="voffset" value="0.5"/></texture></bsdf></shape></scene>)");
    EXPECT_EQ(scene.textures.at(0).uvTransform, glm::dmat3(3, 0, 0, 0, 2, 0, 0.75, 1, 1));
}

}  // namespace
}  // namespace parhelion::test
