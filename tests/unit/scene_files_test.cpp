// The scenes that peers share: each either reads, or says which plugin it needs that we have not.
#include <gtest/gtest.h>

#include "compile/compile_film.h"
#include "support/paths.h"
#include "support/scene_reading.h"

namespace parhelion::test {
namespace {

const std::filesystem::path kShared = std::filesystem::path(test::projectFolder()) / "../shared";
const std::filesystem::path kMitsuba = kShared / "data/mitsuba/tests/scenes/participating_media";

TEST(ProjectScene, EveryOneReadsWithoutNotes) {
    std::size_t count = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(test::projectFolder()) / "scenes")) {
        if (entry.path().extension() != ".xml") continue;
        ++count;
        const SceneDescription scene = readScene(entry.path());
        EXPECT_TRUE(scene.notes.empty()) << entry.path() << ": " << scene.notes.front();
    }
    EXPECT_GT(count, 0u);
}

TEST(BenchmarkScene, FurnaceReads) {
    const std::filesystem::path file = kShared / "benchmark/furnace.xml";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file;
    const SceneDescription scene = readScene(file, {.defines = {{"spp", "16"}}});
    EXPECT_EQ(scene.film.size, glm::uvec2(256));
    EXPECT_EQ(scene.film.filter, ReconstructionFilter::Box);
    EXPECT_EQ(scene.sampleCount, 16u);
    EXPECT_EQ(scene.camera.fovDegrees, 40.0);
    EXPECT_EQ(scene.integrator.rouletteDepth, 1'000'000);
    EXPECT_EQ(scene.media.at(0).sigmaT, glm::dvec3(10.0));
    EXPECT_EQ(scene.media.at(0).albedo, glm::dvec3(1.0));
    EXPECT_EQ(scene.media.at(0).phase.g, 0.5);
    EXPECT_EQ(scene.shapes.at(0).bsdf.type, BsdfDescription::Type::Null);
}

TEST(BenchmarkScene, CornellCloudReads) {
    const std::filesystem::path file = kShared / "benchmark/cornell_cloud.xml";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file;
    const SceneDescription scene = readScene(file);
    ASSERT_EQ(scene.shapes.size(), 7u);
    EXPECT_EQ(scene.shapes[3].bsdf.reflectance, glm::dvec3(0.57, 0.04, 0.05)) << "the left wall refers to red";
    EXPECT_EQ(scene.shapes[5].radiance, glm::dvec3(18.4, 15.6, 8.0));
    ASSERT_TRUE(scene.media.at(0).density.has_value());
    EXPECT_EQ(scene.media[0].density->volume.density.resolution(), glm::uvec3(128, 128, 50));
    // translate(-.5), scale(1.5, 1.5, .6), translate(0, -.15, 0): the corner lands at (-.75, -.9, -.3).
    EXPECT_NEAR(scene.media[0].density->toWorld[3].y, -0.9, 1e-15);
    EXPECT_EQ(scene.media[0].sigmaT, glm::dvec3(60.0));
}

TEST(BenchmarkScene, FogSmallLightReads) {
    const std::filesystem::path file = kShared / "benchmark/fog_small_light.xml";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file;
    const SceneDescription scene = readScene(file);
    ASSERT_EQ(scene.shapes.size(), 4u);
    EXPECT_EQ(scene.shapes[2].center, glm::dvec3(0.7, 1.1, 0.2));
    EXPECT_EQ(scene.shapes[2].radiance, glm::dvec3(400, 340, 260));
    EXPECT_EQ(scene.shapes[3].toWorld[0][0], 3.0);
}

TEST(BenchmarkScene, WdasSunSkyReads) {
    const std::filesystem::path file = kShared / "benchmark/wdas_sun_sky.xml";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file;
    const SceneDescription scene = readScene(file);
    ASSERT_EQ(scene.emitters.size(), 2u);
    EXPECT_NEAR(glm::length(scene.emitters[0].vector), 1.0, 1e-15);
    EXPECT_EQ(scene.media.at(0).density->volume.density.resolution(), glm::uvec3(126, 86, 154));
}

TEST(BenchmarkScene, HdrSkyOnlyReads) {
    const std::filesystem::path file = kShared / "benchmark/hdr_sky_only.xml";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file;
    const SceneDescription scene = readScene(file);
    ASSERT_EQ(scene.emitters.size(), 1u);
    EXPECT_EQ(scene.emitters[0].type, EmitterDescription::Type::EnvironmentMap);
    EXPECT_EQ(scene.emitters[0].map.size, glm::uvec2(1024, 512));
}

TEST(MitsubaTestScene, BackgroundHasItsCheckerboard) {
    const std::filesystem::path included = kMitsuba / "include/test-scene-base.xml";
    if (!std::filesystem::exists(included)) GTEST_SKIP() << "needs " << included;
    const SceneDescription scene = readText("<scene version=\"3.0.0\"><path value=\"" + kMitsuba.string() +
                                            "\"/><default name=\"integrator\" value=\"volpath\"/><include "
                                            "filename=\"include/test-scene-base.xml\"/></scene>");
    EXPECT_GE(scene.textures.size(), 1u);
    EXPECT_EQ(scene.textures[0].type, TextureDescription::Type::Checkerboard);
}

TEST(MitsubaTestScene, WithoutTexturesReads) {
    for (const char* name : {"hetero_sigmat.xml", "homo_null.xml"}) {
        const std::filesystem::path file = std::filesystem::path(test::projectFolder()) / "tests/references" / name;
        if (!std::filesystem::exists(kMitsuba)) GTEST_SKIP() << "needs " << kMitsuba;
        const SceneDescription scene = readScene(file, {.defines = {{"size", "32"}}});
        EXPECT_EQ(scene.shapes.size(), 3u);
        EXPECT_EQ(scene.film.size, glm::uvec2(32));
        EXPECT_NEAR(horizontalFov(scene.camera.fovDegrees, scene.camera.fovAxis, 1.0), 34.022056579589844,
                    1e-5);  // Mitsuba's, in single precision
        EXPECT_EQ(scene.integrator.maxDepth, 6);
    }
}

}  // namespace
}  // namespace parhelion::test
