// Media whose density or albedo comes from a volume file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "support/scene_reading.h"
#include "volume/volume_file.h"

namespace parhelion::test {
namespace {

/// A two-voxel volume in a folder, and media that read it.
class SceneGrid : public testing::Test {
protected:
    void writeGrid(const std::string& name, float first, float second) const {
        Volume volume;
        const float values[] = {first, second};
        volume.density = DensityGrid::fromDense({2, 1, 1}, values);
        volume.boundsMin = {1, 2, 3};
        volume.boundsMax = {3, 3, 7};
        writeVolume(folder_.path() / name, volume);
    }

    SceneDescription read(const std::string& content, const std::string& type = "heterogeneous") const {
        const std::string start = "<shape type=\"cube\"><bsdf type=\"null\"/>\n<medium name=\"interior\" type=\"";
        return readScene(folder_.write("scene.xml", sceneOf(start + type + "\">" + content + "</medium></shape>")));
    }

    const TemporaryFolder folder_;
};

TEST_F(SceneGrid, IsReadFromItsFileAndPlaced) {
    writeGrid("d.vol", 0.25f, 1.0f);
    const SceneDescription scene = read(R"(<float name="scale" value="60"/><volume name="sigma_t" type="gridvolume">
<string name="filename" value="d.vol"/><transform name="to_world"><translate x="-0.5"/></transform></volume>
<volume name="albedo" type="constvolume"><rgb name="value" value="0.9, 0.8, 0.7"/></volume>)");
    const MediumDescription& medium = scene.media.at(0);
    ASSERT_TRUE(medium.density.has_value());
    EXPECT_EQ(medium.density->volume.density.maximum(), 1.0f);
    EXPECT_EQ(medium.density->toWorld[3], glm::dvec4(-0.5, 0, 0, 1)) << "the file's bounds are not asked for";
    EXPECT_EQ(medium.sigmaT, glm::dvec3(60.0)) << "extinction at density 1";
    EXPECT_EQ(medium.albedo, glm::dvec3(0.9, 0.8, 0.7));
}

TEST_F(SceneGrid, FollowsTheBoundsOfTheFileWhenAskedTo) {
    writeGrid("d.vol", 0.25f, 1.0f);
    const SceneDescription scene =
        read(R"(<volume name="sigma_t" type="gridvolume"><string name="filename" value="d.vol"/>
<boolean name="use_grid_bbox" value="true"/><transform name="to_world"><scale value="2"/></transform></volume>)");
    const glm::dmat4& toWorld = scene.media.at(0).density->toWorld;
    // Grid-local (0, 0, 0) and (1, 1, 1) are the corners (1, 2, 3) and (3, 3, 7), then doubled.
    EXPECT_EQ(toWorld * glm::dvec4(0, 0, 0, 1), glm::dvec4(2, 4, 6, 1));
    EXPECT_EQ(toWorld * glm::dvec4(1, 1, 1, 1), glm::dvec4(6, 6, 14, 1));
}

// Other programs leave them 0, and Mitsuba never looks.
TEST_F(SceneGrid, BoundsThatAreNoBoxMatterOnlyWhenAskedFor) {
    writeGrid("d.vol", 0.25f, 1.0f);
    std::string bytes = readTextFile(folder_.path() / "d.vol");
    bytes.replace(24, 24, 24, '\0');  // behind "VOL", version, type, resolution and channels
    folder_.write("d.vol", bytes);
    const std::string file = R"(<volume name="sigma_t" type="gridvolume"><string name="filename" value="d.vol"/>)";
    const SceneDescription scene = read(file + "</volume>");
    EXPECT_EQ(scene.media.at(0).density->volume.density.maximum(), 1.0f);
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_NE(scene.notes[0].find("bounding box is empty"), std::string::npos) << scene.notes[0];
    EXPECT_THROW(read(file + "<boolean name=\"use_grid_bbox\" value=\"true\"/></volume>"), InputError);
}

TEST_F(SceneGrid, OfAlbedoMustStayInTheUnitInterval) {
    writeGrid("a.vol", 0.5f, 1.0f);
    writeGrid("b.vol", 0.5f, 1.5f);
    const auto albedo = [](const std::string& file) {
        return "<volume name=\"albedo\" type=\"gridvolume\">\n<string name=\"filename\" value=\"" + file +
               "\"/></volume>";
    };
    EXPECT_TRUE(read(albedo("a.vol")).media.at(0).albedoGrid.has_value());
    try {
        read(albedo("b.vol"));
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.where().line, 4);
        EXPECT_NE(std::string(error.what()).find("1.5"), std::string::npos) << error.what();
    }
}

TEST_F(SceneGrid, OfExtinctionNeedsAHeterogeneousMedium) {
    writeGrid("d.vol", 0.5f, 1.0f);
    const std::string volume =
        R"(<volume name="sigma_t" type="gridvolume"><string name="filename" value="d.vol"/></volume>)";
    EXPECT_NO_THROW(read(volume));
    EXPECT_THROW(read(volume, "homogeneous"), InputError);
}

TEST_F(SceneGrid, OfExtinctionMayHaveThreeChannels) {
    Volume volume;
    volume.channels = 3;
    volume.color = {{1, 1, 2}, {0.1f, 0.2f, 0.3f, 4, 5, 6}};
    for (const char* name : {"rgb.vol", "rgb.grid"}) {
        writeVolume(folder_.path() / name, volume);
        const SceneDescription scene = read(fmt::format(
            R"(<volume name="sigma_t" type="gridvolume"><string name="filename" value="{}"/></volume>)", name));
        ASSERT_TRUE(scene.media.at(0).density);
        EXPECT_EQ(scene.media[0].density->volume.channels, 3u);
        EXPECT_EQ(scene.media[0].density->volume.color.values, volume.color.values);
        EXPECT_EQ(scene.media[0].sigmaT, glm::dvec3(1));
    }
}

TEST_F(SceneGrid, IsPickedByNameOnlyWhereFilesHaveNames) {
    const auto named = [](const std::string& file, const std::string& name) {
        return "<volume name=\"sigma_t\" type=\"gridvolume\">\n<string name=\"filename\" value=\"" + file +
               "\"/>\n<string name=\"grid_name\" value=\"" + name + "\"/></volume>";
    };
    for (const std::string file : {"d.vol", "d.grid", "d.vdb", "d.nvdb"}) writeGrid(file, 0.5f, 1.0f);
    for (const std::string file : {"d.vdb", "d.nvdb"}) EXPECT_NO_THROW(read(named(file, "density"))) << file;
    for (const std::string file : {"d.vol", "d.grid"}) try {
            read(named(file, "smoke"));
            FAIL() << "accepted: " << file;
        } catch (const InputError& error) {
            EXPECT_EQ(error.where().line, 5) << error.what();
            EXPECT_NE(std::string(error.what()).find("got \"smoke\""), std::string::npos) << error.what();
        }
}

}  // namespace
}  // namespace parhelion::test
