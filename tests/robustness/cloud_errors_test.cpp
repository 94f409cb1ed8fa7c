// Procedural clouds in scene files: what they mean, and what is refused.
#include <gtest/gtest.h>

#include "support/bad_text.h"
#include "volume/volume_file.h"

namespace parhelion::test {
namespace {

std::string cloudOf(const std::string& content) {
    return mediumOf("<volume name=\"sigma_t\" type=\"procedural_cloud\">" + content + "</volume>", "heterogeneous");
}

std::string number(const std::string& name, const std::string& value) {
    return cloudOf("<float name=\"" + name + "\" value=\"@@" + value + "\"/>");
}

std::string integer(const std::string& name, const std::string& value) {
    return cloudOf("<integer name=\"" + name + "\" value=\"@@" + value + "\"/>");
}

std::vector<BadText> badClouds() {
    return {
        {"NanDetail", number("detail_amount", "nan"), {"finite number", "nan"}},
        {"InfiniteDetail", number("detail_amount", "inf"), {"finite number", "inf"}},
        {"NegativeDetail", number("detail_amount", "-0.1"), {"\"detail_amount\" must be in [0, 4]", "got -0.1"}},
        {"NoNoiseScale", number("noise_scale", "0"), {"(0, 256]", "got 0"}},
        {"LargeNoiseScale", number("noise_scale", "300"), {"(0, 256]", "got 300"}},
        {"NegativeWarp", number("warp_amount", "-1"), {"[0, 4]"}},
        {"NegativeErosion", number("erosion_amount", "-1"), {"[0, 4]"}},
        {"NoWidth", number("surface_width", "0"), {"[0.001, 4]", "got 0"}},
        {"NegativeDensity", number("density_scale", "-2"), {"[0, 1000]"}},
        {"ThresholdAboveOne", number("density_threshold", "1.5"), {"[0, 1]"}},
        {"NegativeSeed", integer("noise_seed", "-1"), {"noise_seed", "-1"}},
        {"NegativeResolution", integer("bake_resolution", "-8"), {"bake_resolution", "-8"}},
        {"HugeResolution", integer("bake_resolution", "4096"), {"1024", "4096"}},
        {"FractionalResolution", cloudOf("@@<float name=\"bake_resolution\" value=\"64\"/>"), {"<integer>"}},
        {"NamesOfTheReport", cloudOf("@@<float name=\"detailAmount\" value=\"1\"/>"), {"detail_amount"}},
        {"ConstantToModulate", cloudOf("@@<volume type=\"constvolume\"/>"), {"must be a gridvolume"}},
        {"CloudToModulate", cloudOf("@@<volume type=\"procedural_cloud\"/>"), {"must be a gridvolume"}},
        {"ScaleOfModulated",
         cloudOf("<float name=\"density_scale\" value=\"@@2\"/><volume type=\"constvolume\"/>"),
         {"\"density_scale\" does not go with a density to modulate"}},
        {"PlaceOfModulated",
         cloudOf("@@<transform name=\"to_world\"/><volume type=\"constvolume\"/>"),
         {"\"to_world\" does not go with a density to modulate"}},
        {"AsAlbedo",
         mediumOf("<volume name=\"albedo\" type=\"@@procedural_cloud\"/>", "heterogeneous"),
         {"gridvolume, constvolume"}},
        {"InHomogeneous",
         mediumOf("@@<volume name=\"sigma_t\" type=\"procedural_cloud\"/>"),
         {"use type \"heterogeneous\""}},
    };
}

class BadCloud : public testing::TestWithParam<BadText> {};
TEST_P(BadCloud, IsRefusedWhereItIsWritten) { expectRefused(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Scenes, BadCloud, testing::ValuesIn(badClouds()), nameOfBadText);

TEST(ProceduralCloudScene, DefaultsAreThoseOfTheSweep) {
    const SceneDescription scene = readText(cloudOf(""));
    ASSERT_TRUE(scene.media.at(0).density && scene.media[0].density->cloud);
    const shared::CloudField& field = *scene.media[0].density->cloud;
    EXPECT_EQ(field.detailAmount, 0.62f);
    EXPECT_EQ(field.noiseScale, 2.6f);
    EXPECT_EQ(field.warpAmount, 0.28f);
    EXPECT_EQ(field.erosionAmount, 0.30f);
    EXPECT_EQ(field.surfaceWidth, 0.14f);
    EXPECT_EQ(field.densityScale, 0.85f);
    EXPECT_EQ(field.densityThreshold, 0.02f);
    EXPECT_EQ(field.noiseSeed, 4u);
    EXPECT_EQ(field.resolution, glm::uvec3(128));
    EXPECT_EQ(field.modulates, 0u);
}

TEST(ProceduralCloudScene, ModulatedDensityHasOneChannel) {
    const TemporaryFolder folder;
    Volume volume;
    volume.channels = 3;
    volume.color = {{1, 1, 1}, {0.1f, 0.2f, 0.3f}};
    writeVolume(folder.path() / "rgb.vol", volume);
    const std::string content = "<volume type=\"gridvolume\"><string name=\"filename\" value=\"rgb.vol\"/></volume>";
    try {
        readScene(folder.write("scene.xml", cloudOf(content)));
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("one channel"), std::string::npos) << error.what();
    }
}

TEST(ProceduralCloudScene, ModulatedTakesPlaceAndShapeOfItsDensity) {
    const TemporaryFolder folder;
    Volume volume;
    volume.density = DensityGrid({8, 4, 2});
    volume.density.set({1, 1, 1}, 0.5f);
    writeVolume(folder.path() / "d.grid", volume);
    const std::string grid = R"(<volume type="gridvolume"><string name="filename" value="d.grid"/>
        <transform name="to_world"><translate x="3"/></transform></volume>)";
    const auto fieldOf = [&](const std::string& content) {
        const GridPlacement placement = *readScene(folder.write("scene.xml", cloudOf(content))).media.at(0).density;
        EXPECT_EQ(placement.toWorld[3].x, 3);
        EXPECT_EQ(placement.volume.density.at({1, 1, 1}), 0.5f);
        return *placement.cloud;
    };
    EXPECT_EQ(fieldOf(grid).resolution, glm::uvec3(8, 4, 2));
    EXPECT_EQ(fieldOf(grid).modulates, 1u);
    EXPECT_EQ(fieldOf(grid).densityThreshold, 0.0f);
    EXPECT_EQ(fieldOf(R"(<integer name="bake_resolution" value="32"/>)" + grid).resolution, glm::uvec3(32, 16, 8));
}

}  // namespace
}  // namespace parhelion::test
