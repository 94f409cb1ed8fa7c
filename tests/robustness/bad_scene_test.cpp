// Bad scenes: a message with the place, exit code 2, and nothing written.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

#include "support/paths.h"
#include "support/run_program.h"
#include "support/scene_text.h"

namespace parhelion::test {
namespace {

struct BadScene {
    std::string name;
    SceneText scene;
    std::string culprit;   ///< first appears on the line to blame
    std::string mentions;  ///< what the message must say

    friend void PrintTo(const BadScene& bad, std::ostream* stream) { *stream << bad.name; }
};

BadScene replaced(std::string name, std::string SceneText::*part, std::string text, std::string culprit,
                  std::string mentions) {
    BadScene bad{std::move(name), {}, std::move(culprit), std::move(mentions)};
    bad.scene.*part = std::move(text);
    return bad;
}

std::string medium(const std::string& content) {
    return "<medium id=\"fog\" type=\"homogeneous\">\n" + content + "\n</medium>";
}

std::string cube(const std::string& content) {
    return "<shape type=\"cube\"><bsdf type=\"null\"/><ref id=\"fog\" name=\"interior\"/>\n" + content + "\n</shape>";
}

std::vector<BadScene> badScenes() {
    const auto M = &SceneText::medium;
    const auto S = &SceneText::shape;
    return {
        replaced("UnknownShape", S, "<shape type=\"spehre\"/>", "spehre", "sphere"),
        replaced("UnknownEmitter", &SceneText::emitter, "<emitter type=\"sunny\"/>", "sunny", "sunny"),
        replaced("UnknownMedium", M, "<medium id=\"fog\" type=\"homogenous\"/>", "homogenous", "homogeneous"),
        replaced("UnknownProperty", M, medium("<float name=\"scael\" value=\"1\"/>"), "scael", "scale"),
        replaced("UnknownTag", S, "<shpae type=\"cube\"/>", "shpae", "shpae"),
        replaced("WrongType", &SceneText::integrator,
                 "<integrator type=\"volpath\">\n<string name=\"max_depth\" value=\"8\"/></integrator>", "max_depth",
                 "max_depth"),
        replaced("NumberIsNoNumber", &SceneText::width, "<integer name=\"width\" value=\"many\"/>", "many", "many"),
        replaced("NumberWithTail", &SceneText::width, "<integer name=\"width\" value=\"16px\"/>", "16px", "16px"),
        replaced("ZeroWidthFilm", &SceneText::width, "<integer name=\"width\" value=\"0\"/>", "width", "got 0"),
        replaced("NegativeWidthFilm", &SceneText::width, "<integer name=\"width\" value=\"-16\"/>", "width", "-16"),
        replaced("HugeFilm", &SceneText::width, "<integer name=\"width\" value=\"4000000000\"/>", "width",
                 "4000000000"),
        replaced("NanExtinction", M, medium("<rgb name=\"sigma_t\" value=\"1, nan, 1\"/>"), "sigma_t", "nan"),
        replaced("InfiniteExtinction", M, medium("<float name=\"sigma_t\" value=\"inf\"/>"), "sigma_t", "inf"),
        replaced("NegativeExtinction", M, medium("<rgb name=\"sigma_t\" value=\"1, -2, 1\"/>"), "sigma_t", "-2"),
        replaced("NegativeScale", M, medium("<float name=\"scale\" value=\"-3\"/>"), "scale", "-3"),
        replaced("AlbedoAboveOne", M, medium("<rgb name=\"albedo\" value=\"0.5, 1.5, 0.5\"/>"), "albedo", "1.5"),
        replaced("SingularTransform", S,
                 cube("<transform name=\"to_world\"><scale x=\"1\" y=\"0\" z=\"1\"/></transform>"), "y=\"0\"",
                 "singular"),
        replaced("NanTransform", S, cube("<transform name=\"to_world\"><translate x=\"nan\"/></transform>"), "nan",
                 "nan"),
        replaced("MissingMesh", S, "<shape type=\"obj\">\n<string name=\"filename\" value=\"no.obj\"/></shape>",
                 "no.obj", "no.obj"),
        replaced("MissingVolume", M, gridMedium("no.vol"), "no.vol", "no.vol"),
        replaced("MissingInclude", &SceneText::start, "<include filename=\"no.xml\"/>", "no.xml", "no.xml"),
        replaced("CyclicInclude", &SceneText::start, "<include filename=\"scene.xml\"/>", "scene.xml", "scene.xml"),
        replaced("UnknownReference", S, "<shape type=\"cube\"><ref id=\"mist\" name=\"interior\"/></shape>", "mist",
                 "mist"),
        replaced("UndefinedVariable", &SceneText::width, "<integer name=\"width\" value=\"$w\"/>", "$w", "w"),
        replaced("MalformedXml", S, "<shape type=\"cube\"", "<shape", ""),
        replaced("EndsEarly", &SceneText::end, "", "", ""),
    };
}

/// 1-based number of the line on which `culprit` first appears.
long lineOf(const std::string& text, const std::string& culprit) {
    return 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(culprit)), '\n');
}

class BadSceneInput : public testing::TestWithParam<BadScene> {};

TEST_P(BadSceneInput, IsRefusedWithItsPlaceAndWritesNothing) {
    const BadScene& bad = GetParam();
    const TemporaryFolder folder;
    const std::string text = bad.scene.text();
    folder.write("scene.xml", text);
    const ProgramResult result = runProgram(test::programFile(), {"render", "scene.xml"}, folder.path());
    EXPECT_EQ(result.exitCode, 2) << result.error;
    EXPECT_EQ(result.output, "");
    // Where a document stops making sense is the parser's to say; elsewhere the line is the culprit's.
    const bool malformed = bad.mentions.empty();
    const std::string place =
        "parhelion: error: scene.xml:" + (malformed ? "" : std::to_string(lineOf(text, bad.culprit)) + ":");
    EXPECT_EQ(result.error.substr(0, place.size()), place) << result.error;
    EXPECT_NE(result.error.find(bad.mentions), std::string::npos) << result.error;
    EXPECT_EQ(folder.names(), std::set<std::string>{"scene.xml"});
}

INSTANTIATE_TEST_SUITE_P(Scenes, BadSceneInput, testing::ValuesIn(badScenes()),
                         [](const auto& info) { return info.param.name; });

TEST(GoodSceneInput, IsAccepted) {
    // The control: what every bad scene was made from.
    const TemporaryFolder folder;
    folder.write("scene.xml", SceneText{}.text());
    const ProgramResult result = runProgram(test::programFile(), {"inspect", "scene.xml"}, folder.path());
    EXPECT_EQ(result.exitCode, 0) << result.error;
}

TEST(BadSceneFile, MissingIsRefused) {
    const TemporaryFolder folder;
    const ProgramResult result = runProgram(test::programFile(), {"render", "nowhere.xml"}, folder.path());
    EXPECT_EQ(result.exitCode, 2) << result.error;
    EXPECT_EQ(result.error.rfind("parhelion: error: nowhere.xml", 0), 0u) << result.error;
    EXPECT_TRUE(folder.names().empty());
}

TEST(BadSceneFile, EmptyFolderAndBinaryAreRefused) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "folder.xml");
    folder.write("empty.xml", "");
    folder.write("binary.xml", std::string("\0\xff\xfe<scene\x01", 11));
    for (const std::string name : {"folder.xml", "empty.xml", "binary.xml"}) {
        const ProgramResult result = runProgram(test::programFile(), {"render", name}, folder.path());
        EXPECT_EQ(result.exitCode, 2) << name << ": " << result.error;
        EXPECT_EQ(result.error.rfind("parhelion: error: " + name, 0), 0u) << result.error;
    }
}

TEST(BadSceneFile, CycleOfTwoIsRefusedInTheFileThatClosesIt) {
    const TemporaryFolder folder;
    SceneText scene;
    scene.start = "<include filename=\"other.xml\"/>";
    folder.write("scene.xml", scene.text());
    folder.write("other.xml", "<scene version=\"3.0.0\">\n<include filename=\"scene.xml\"/>\n</scene>");
    const ProgramResult result = runProgram(test::programFile(), {"render", "scene.xml"}, folder.path());
    EXPECT_EQ(result.exitCode, 2) << result.error;
    EXPECT_NE(result.error.find("other.xml:2:"), std::string::npos) << result.error;
}

}  // namespace
}  // namespace parhelion::test
