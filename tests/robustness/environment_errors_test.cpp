// Environment maps that are missing, damaged or hold what is no light, and properties that are wrong.
#include <gtest/gtest.h>

#include <limits>

#include "image/image.h"
#include "support/bad_text.h"
#include "support/temporary_folder.h"

namespace parhelion::test {
namespace {

/// A Radiance file of 2 x 3 texels.
const std::string kMap = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 2\n" + std::string(24, '\x80');

BadText mapOf(const std::string& name, const std::string& content, const std::vector<std::string>& mentions) {
    return {name,
            sceneOf("<emitter type=\"envmap\">\n<string name=\"filename\" value=\"a.hdr\"/>" + content + "</emitter>"),
            mentions,
            {{"a.hdr", kMap}}};
}

std::vector<BadText> badMaps() {
    return {
        {"NoFileName", sceneOf("@@<emitter type=\"envmap\"/>"), {"filename"}},
        {"MissingFile",
         sceneOf("<emitter type=\"envmap\"><string name=\"filename\" value=\"@@b.hdr\"/></emitter>"),
         {"b.hdr"}},
        {"OtherFormat",
         sceneOf("<emitter type=\"envmap\"><string name=\"filename\" value=\"a.hdr\"/></emitter>"),
         {".exr, .hdr, .png or .jpg"},
         {{"a.hdr", "no picture"}}},
        {"Truncated",
         sceneOf("<emitter type=\"envmap\"><string name=\"filename\" value=\"a.hdr\"/></emitter>"),
         {"a.hdr"},
         {{"a.hdr", kMap.substr(0, 30)}}},
        mapOf("NegativeScale", "<float name=\"scale\" value=\"@@-1\"/>", {"\"scale\" must be in [0", "got -1"}),
        mapOf("ColouredScale", "@@<rgb name=\"scale\" value=\"1 2 3\"/>", {"must be a <float>"}),
        mapOf("Scaling", "@@<transform name=\"to_world\"><scale value=\"2\"/></transform>",
              {"must not scale or shear"}),
        mapOf("Stretching", "@@<transform name=\"to_world\"><scale x=\"2\"/></transform>", {"must not scale or shear"}),
        mapOf("UnknownMapProperty", "@@<boolean name=\"mis\" value=\"true\"/>", {"unknown property \"mis\""}),
        {"MapBesidesSky",
         sceneOf("<emitter type=\"sky\"/>\n@@<emitter type=\"envmap\"><string name=\"filename\" "
                 "value=\"a.hdr\"/></emitter>"),
         {"only one emitter", "scene.xml:2:1"},
         {{"a.hdr", kMap}}},
    };
}

class BadEnvironmentMap : public testing::TestWithParam<BadText> {};
TEST_P(BadEnvironmentMap, IsRefusedWithItsPlace) { expectRefused(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Maps, BadEnvironmentMap, testing::ValuesIn(badMaps()), nameOfBadText);

// H56: named, not repaired.
TEST(EnvironmentTexels, ThatAreNoLightAreRefusedWithTheirPlace) {
    const TemporaryFolder folder;
    for (const float value : {-0.5f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Image image;
        image.size = {4, 3};
        for (const char* channel : {"R", "G", "B"}) image.channels[channel].assign(12, 1.0f);
        image.channels["G"][6] = value;
        writeExr(folder.path() / "map.exr", image);
        const std::filesystem::path scene = folder.write(
            "scene.xml", sceneOf("<emitter type=\"envmap\"><string name=\"filename\" value=\"map.exr\"/></emitter>"));
        try {
            readScene(scene);
            FAIL() << value << " was accepted";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("in channel G at column 2, row 1"), std::string::npos)
                << error.what();
        }
    }
}

// Every truncation of a map is read or refused; nothing else.
TEST(EnvironmentTexels, OfTruncatedFilesAreReadOrRefused) {
    const TemporaryFolder folder;
    for (std::size_t length = 0; length < kMap.size(); ++length) {
        folder.write("a.hdr", kMap.substr(0, length));
        const std::filesystem::path scene = folder.write(
            "scene.xml", sceneOf("<emitter type=\"envmap\"><string name=\"filename\" value=\"a.hdr\"/></emitter>"));
        try {
            readScene(scene);
        } catch (const InputError&) {
        }
    }
}

}  // namespace
}  // namespace parhelion::test
