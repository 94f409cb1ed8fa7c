// OBJ files as people's tools write them: encodings, line ends, comments, continued lines, extreme numbers.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "scene/attribute_values.h"
#include "scene/obj_mesh.h"
#include "support/scene_reading.h"
#include "support/temporary_folder.h"

namespace parhelion::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kBom = "\xef\xbb\xbf";
const std::string kCorners = "v 1 2 3\nv 2 0 0\nv 0 1 0\n";

Mesh readObj(const std::string& text) {
    const TemporaryFolder folder;
    return readObjMesh(folder.write("mesh.obj", text), {}, {});
}

/// One triangle with the corners of kCorners, with nothing left out.
void expectTriangle(const std::string& text) {
    SCOPED_TRACE(text);
    const Mesh mesh = readObj(text);
    const std::vector<glm::dvec3> corners{{1, 2, 3}, {2, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(mesh.positions, corners);
    EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 1, 2)));
    EXPECT_THAT(mesh.notes, ElementsAre());
}

TEST(ObjFile, ByteOrderMarksAreSkipped) {
    expectTriangle(kBom + kCorners + "f 1 2 3\n");
    expectTriangle(kBom + "# made by an editor\n" + kCorners + "f 1 2 3\n");
    expectTriangle(kCorners + kBom + "f 1 2 3\n");  // joined from two files
}

TEST(ObjFile, StatementsGoOnBehindABackslash) {
    for (const std::string& end : std::vector<std::string>{"\n", "\r\n", "\r"}) {
        expectTriangle(kCorners + "f 1 2 \\" + end + "3" + end);
        expectTriangle(kCorners + "f \\" + end + "\\" + end + "1 2\\" + end + "\t3");
        expectTriangle("v 1 \\  " + end + " 2 3" + end + "v 2 0 0" + end + "v\\" + end + "0 1 0" + end + "f 1 2 3");
    }
    expectTriangle(kCorners + "f 1 2 \\ # the third one follows\n3\n");
    expectTriangle(kCorners + "f 1 2 3 \\");  // nothing follows
    expectTriangle(kCorners + "g front \\\nback\nf 1 2 3\n");
    const Mesh mesh = readObj(kCorners + "vt 0.25 \\\n0.5\nvn 0 \\\n0 1\nf 1/1/1 2/1/1 \\\n3/1/1\n");
    EXPECT_EQ(mesh.uvs.at(0), glm::dvec2(0.25, 0.5));
    EXPECT_EQ(mesh.normals.at(2), glm::dvec3(0, 0, 1));
}

TEST(ObjFile, CommentsMayStandBehindEveryStatement) {
    expectTriangle("#\nv 1 2 3# x\nv 2 0 0 # 1\nv 0 1 0 ##\nf 1 2 3 # 4\n");
    const Mesh mesh = readObj(kCorners + "vt 0.25 0.5#0.75\nvn 0 0 1 # up\nf 1/1/1 2/1/1 3/1/1#\n");
    EXPECT_EQ(mesh.uvs.at(0), glm::dvec2(0.25, 0.5));
    EXPECT_EQ(mesh.normals.at(0), glm::dvec3(0, 0, 1));
}

// What a C library writes for NaN and infinity holds a #, and so do names of materials.
TEST(ObjFile, CommentsDoNotBeginWithinNumbersAndNames) {
    for (const char* number : {"1.#QNAN", "-1.#IND00", "1.#INF", "1.#SNAN"}) {
        EXPECT_THROW(readObj(fmt::format("v 1 2 {}\nv 2 0 0\nv 0 1 0\nf 1 2 3\n", number)), InputError) << number;
        EXPECT_THROW(readObj(kCorners + fmt::format("vt 0 {}\nf 1/1 2/1 3/1\n", number)), InputError) << number;
    }
    expectTriangle("v 1. 2. 3.#third\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
    const Mesh mesh = readObj(kCorners + "usemtl a#1\nf 1 2 3\nusemtl a#2\nf 1 2 3\n");
    EXPECT_THAT(mesh.notes, ElementsAre(HasSubstr("the 2 materials")));
}

// `mtllib C:\models\` before a statement: the backslash is the name's.
TEST(ObjFile, NamesMayEndInABackslash) {
    const Mesh mesh = readObj("mtllib C:\\models\\\n" + kCorners + "g left\\\nf 1 2 3\nusemtl x\\\r\nf 1 2 3\n");
    EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(ObjFile, IndicesMayHaveASignAndSayWhenTheyAreTooLarge) {
    expectTriangle(kCorners + "f +1 +2 3\n");
    for (const char* index : {"99999999999", "2147483648"}) try {
            readObj(kCorners + fmt::format("f 1 2 {}\n", index));
            ADD_FAILURE() << index;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr("beyond what a mesh may have"));
        }
    for (const char* index : {"++1", "+-1", "+", "+0"})
        EXPECT_THROW(readObj(kCorners + fmt::format("f {} 2 3\n", index)), InputError) << index;
}

TEST(ObjFile, BackslashInACommentJoinsNothing) {
    expectTriangle("# C:\\models\\\n" + kCorners + "f 1 2 3 # D:\\\n");
    expectTriangle("v 1 2 3 # first \\\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
}

TEST(ObjFile, SlashesMayEndACorner) {
    for (const std::string& face : std::vector<std::string>{"1// 2// 3//", "1/ 2/ 3/", "1// 2 3/", "-3// -2// -1//"})
        expectTriangle(kCorners + "f " + face + "\n");
    const Mesh mesh = readObj(kCorners + "vt 0.25 0.5\nf 1/1/ 2/1/ 3/1\n");
    EXPECT_EQ(mesh.uvs.at(2), glm::dvec2(0.25, 0.5));
}

TEST(ObjFile, LineEndsAndSpacesDoNotMatter) {
    for (const std::string& end : std::vector<std::string>{"\n", "\r\n", "\r", " \t\n", "\n\n  \n", "\f\n"})
        expectTriangle("v 1 2 3" + end + "\tv\t2 0  0" + end + "v 0 1 0" + end + "f 1 2 3" + end);
    expectTriangle(kCorners + "f 1 2 3");
}

TEST(ObjFile, NumbersTooSmallAreZero) {
    for (const std::string& tiny :
         std::vector<std::string>{"1e-46", "1e-310", "-1e-320", "1e-400", "+1E-99999999999999999999", "0e99999999999",
                                  "0." + std::string(400, '0') + "1"}) {
        const Mesh mesh = readObj("v 1 " + tiny + " 3\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
        EXPECT_EQ(mesh.positions.at(0), glm::dvec3(1, 0, 3)) << tiny;
    }
    // The smallest float that has all its bits, and one that does not.
    const Mesh mesh = readObj("v 1.17549435e-38 1.4e-45 3\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(mesh.positions.at(0), glm::dvec3(0x1p-126, 0x1p-149, 3));
}

TEST(ObjFile, NumbersKeepTheirValueInEveryForm) {
    const std::string many(350, '0');
    for (const std::string& two :
         std::vector<std::string>{"2", "+2.", "2e0", "2E+00", "0.2e1", "2" + many + "e-350", "0." + many + "2e351",
                                  "2.000000000000000000000000000000000000000"}) {
        const Mesh mesh = readObj("v 1 " + two + " 3\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
        EXPECT_EQ(mesh.positions.at(0), glm::dvec3(1, 2, 3)) << two;
    }
    EXPECT_EQ(readObj("v 3e38 2 3\nv 2 0 0\nv 0 1 0\nf 1 2 3\n").positions.at(0).x, double(3e38f));
}

TEST(ObjFile, NamesAndLooksAreLeftOutInSilence) {
    expectTriangle("mtllib none.mtl\no a b\ng front back\n" + kCorners +
                   "usemtl red\ns 1\ns off\nmg 1 2\nlod 0\nbevel off\nfo 1 2 3\nusemtl red\n");
}

TEST(ObjFile, GeometryThatIsNotReadIsNotedWhereItStarts) {
    const Mesh mesh = readObj(kCorners + "p 1\nl 1 2\nf 1 2 3\nl 2 \\\n3\ncurv2 1 2\nd\xc3\xa9part 1\n");
    ASSERT_EQ(mesh.notes.size(), 2u);
    EXPECT_THAT(mesh.notes[0], HasSubstr("mesh.obj:4:1: only polygons"));
    EXPECT_THAT(mesh.notes[0], HasSubstr("\"curv2\" (1), \"l\" (2), \"p\" (1)"));
    EXPECT_THAT(mesh.notes[1], HasSubstr("mesh.obj:10:1: statements that OBJ does not have"));
    EXPECT_THAT(mesh.notes[1], HasSubstr("\"d??part\" (1)"));  // notes end in JSON, which is UTF-8
}

TEST(ObjFile, ColoursWeightsAndMaterialsAreNoted) {
    const Mesh mesh =
        readObj("v 1 2 3 1\nv 2 0 0 0.5\nv 0 1 0 1 0.5 0\nv 0 0 1 1 0 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 4\n");
    ASSERT_EQ(mesh.notes.size(), 3u);
    EXPECT_THAT(mesh.notes[0], HasSubstr("mesh.obj:3:1: the colours of 2 vertices"));
    EXPECT_THAT(mesh.notes[1], HasSubstr("mesh.obj:2:1: the weights of 1 vertices"));
    EXPECT_THAT(mesh.notes[2], HasSubstr("mesh.obj:7:1: the 2 materials"));
}

TEST(ObjFile, NotesReachTheScene) {
    const SceneDescription scene =
        readText(sceneOf("<shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/></shape>"), {},
                 {{"m.obj", kCorners + "f 1 2 3\nl 1 2\n"}});
    EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("m.obj:5:1: only polygons")));
}

TEST(SceneText, EncodingIsNamed) {
    const std::string scene = sceneOf("");
    std::string wide;
    for (const char c : scene) wide += {c, '\0'};
    for (const auto& [text, name] : std::map<std::string, std::string>{
             {"\xff\xfe" + wide, "UTF-16"}, {wide, "UTF-16"}, {"\x1f\x8b\x08", "gzip"}, {scene + '\0', "is 0"}}) {
        try {
            readText(text);
            ADD_FAILURE() << name;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr(name));
        }
    }
    EXPECT_NO_THROW(readText(kBom + scene));
}

TEST(SceneNumbers, TooSmallForADoubleAreZeroAndTooLargeNone) {
    EXPECT_EQ(numberOrNan("1e-400"), 0.0);
    EXPECT_EQ(numberOrNan(" -3.5E-99999999999999999999 "), 0.0);
    EXPECT_EQ(numberOrNan("5e-324"), 0x1p-1074);
    for (const char* none : {"1e309", "-1e99999999999999999999", "1e-400x", "1e-4 00", "", "."})
        EXPECT_TRUE(std::isnan(numberOrNan(none))) << none;
}

}  // namespace
}  // namespace parhelion::test
