// Damaged OBJ files: never zeros in place of what cannot be read.
#include <gtest/gtest.h>

#include <array>

#include "support/bad_text.h"

namespace parhelion::test {
namespace {

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

BadText mesh(const std::string& name, const std::string& text, const std::vector<std::string>& mentions) {
    return {name,
            sceneOf("<shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/></shape>"),
            mentions,
            {{"m.obj", text}}};
}

/// Each character of `text` in `width` bytes, of which it is number `place`.
std::string widened(const std::string& text, std::size_t width, std::size_t place) {
    std::string wide(text.size() * width, '\0');
    for (std::size_t i = 0; i < text.size(); ++i) wide[i * width + place] = text[i];
    return wide;
}

/// Files that are no OBJ text: the message says what they are.
std::vector<BadText> otherFiles() {
    using namespace std::string_literals;
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
    const std::vector<std::array<std::string, 3>> files{
        {"Utf16LittleEndian", "\xff\xfe" + widened(obj, 2, 0), "UTF-16"},
        {"Utf16BigEndian", "\xfe\xff" + widened(obj, 2, 1), "UTF-16"},
        {"Utf16LittleEndianUnmarked", widened(obj, 2, 0), "UTF-16"},
        {"Utf16BigEndianUnmarked", widened(obj, 2, 1), "UTF-16"},
        {"Utf32LittleEndian", "\xff\xfe\0\0"s + widened(obj, 4, 0), "UTF-32"},
        {"Utf32BigEndian", "\0\0\xfe\xff"s + widened(obj, 4, 3), "UTF-32"},
        {"Utf32Unmarked", widened(obj, 4, 0), "UTF-32"},
        {"Gzip", "\x1f\x8b\x08\0\0\0\0\0\0\x03"s, "gzip"},
        {"Zip", "PK\x03\x04\x14\0"s, "zip"},
        {"Zstandard", "\x28\xb5\x2f\xfd\x04", "zstd"},
        {"Ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "PLY"},
        {"Stl", "solid cube\nfacet normal 0 0 1\n", "STL"},
        {"Usd", "#usda 1.0\n", "USD"},
        {"LfsPointer", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "Git LFS"},
        {"WebPage", "<!DOCTYPE html>\n<html></html>\n", "HTML"},
        {"ZerosAtTheEnd", obj + "\0\0"s, "byte 32 is 0"}};
    std::vector<BadText> bad;
    for (const auto& [name, content, mention] : files) bad.push_back(mesh(name, content, {mention, "OBJ"}));
    return bad;
}

/// Forms of numbers, corners and statements.
std::vector<BadText> badStatements() {
    return {
        mesh("VertexBeyondDouble", "v 0 0 @@-1e400\n", {"-1e400"}),
        mesh("VertexIsInfinite", "v 0 @@inf 0\n", {"finite", "inf"}),
        mesh("DecimalComma", "v @@0,5 0 0\n", {"0,5"}),
        mesh("CornerWithoutVertex", kSquare + "vt 0 0\nf 1/1 @@/1 3/1\n", {"vertex index", "/1"}),
        mesh("BackslashWithinALine", kSquare + "f 1 @@\\ 2 3\n", {"vertex index"}),
        mesh("ContinuedFace", kSquare + "f 1 \\\r\n2 \\\r\n @@7\r\n", {"vertex index 7"}),
        mesh("ContinuedVertex", "v 0 \\\n\\\n0 @@nan\n", {"nan"}),
        mesh("ContinuedFaceTooShort", kSquare + "# \\\n\n @@f 1 \\\n2\nf 1 2 3\n", {"at least 3"}),
        mesh("FaceBehindAContinuation", kSquare + "f 1 2 \\\n3\n\nf 1 @@x 3\n", {"\"x\""}),
        mesh("KeywordsInCapitals", "V 0 0 0\nV 1 0 0\nV 1 1 0\nF 1 2 3\n", {"got none", "\"F\" (1), \"V\" (3)"}),
    };
}

std::vector<BadText> badMeshes() {
    return {
        {"MissingMesh",
         sceneOf("<shape type=\"obj\"><string name=\"filename\" value=\"@@m.obj\"/></shape>"),
         {"m.obj", "not found"}},
        {"MeshWithoutName", sceneOf("@@<shape type=\"obj\"/>"), {"filename"}},
        mesh("MeshWithoutFaces", kSquare, {"needs faces"}),
        mesh("MeshIsBinary", std::string("\x7f\x45LF\0\1\2", 7), {"needs faces"}),
        mesh("VertexIsNan", "v 0 0 0\nv 1 @@nan 0\n", {"finite", "nan"}),
        mesh("VertexIsDamaged", "v 0 0 0\nv 1 0 @@0x\n", {"0x"}),
        mesh("VertexBeyondFloat", "v 0 0 @@1e39\n", {"1e39"}),
        mesh("VertexWithTwoNumbers", "v 0 0 0\n@@v 1 0\n", {"needs 3 numbers", "got 2"}),
        mesh("IndexPastTheEnd", kSquare + "f 1 2 @@5\n", {"vertex index 5", "has 4"}),
        mesh("IndexZero", kSquare + "f 1 @@0 3\n", {"other than 0"}),
        mesh("IndexBeforeTheStart", kSquare + "f 1 2 @@-5\n", {"-5"}),
        mesh("IndexBeyondInteger", kSquare + "f 1 2 @@99999999999\n", {"99999999999"}),
        mesh("MissingNormal", kSquare + "f @@1//1 2//1 3//1\n", {"normal"}),
        mesh("CornerWithFourParts", kSquare + "vt 0 0\nvn 0 0 1\nf 1 2 @@3/1/1/1\n", {"v/vt/vn"}),
        mesh("FaceWithTwoCorners", kSquare + "@@f 1 2\n", {"at least 3", "got 2"}),
        mesh("ConcavePolygon", kSquare + "v 0.1 0.5 0\n@@f 1 2 5 3 4\n", {"concave"}),
        mesh("NormalsForSomeCorners", kSquare + "vn 0 0 1\nf 1//1 2//1 3//1\n@@f 1 3 4\n", {"face_normals"}),
        mesh("NormalOfLengthZero", kSquare + "vn 0 0 0\n@@f 1//1 2//1 3//1\n", {"length zero"}),
        mesh("NormalsCancel", kSquare + "f 1 2 3\nf 1 3 2\n", {"cancel out", "face_normals"}),
    };
}

class MeshError : public testing::TestWithParam<BadText> {};

TEST_P(MeshError, NamesTheCauseAndItsPlace) { expectRefused(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Obj, MeshError, testing::ValuesIn(badMeshes()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(ObjStatement, MeshError, testing::ValuesIn(badStatements()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(ObjOther, MeshError, testing::ValuesIn(otherFiles()), nameOfBadText);

}  // namespace
}  // namespace parhelion::test
