// Damaged OBJ files: never zeros in place of what cannot be read.
#include <gtest/gtest.h>

#include "support/bad_text.h"

namespace parhelion::test {
namespace {

std::vector<BadText> badMeshes() {
    const std::string scene = sceneOf("<shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/></shape>");
    const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    const auto mesh = [&](std::string name, std::string text, std::vector<std::string> mentions) {
        return BadText{std::move(name), scene, std::move(mentions), {{"m.obj", std::move(text)}}};
    };
    return {
        {"MissingMesh",
         sceneOf("<shape type=\"obj\"><string name=\"filename\" value=\"@@m.obj\"/></shape>"),
         {"m.obj", "not found"}},
        {"MeshWithoutName", sceneOf("@@<shape type=\"obj\"/>"), {"filename"}},
        mesh("MeshWithoutFaces", square, {"needs faces"}),
        mesh("MeshIsBinary", std::string("\x7f\x45LF\0\1\2", 7), {"needs faces"}),
        mesh("VertexIsNan", "v 0 0 0\nv 1 @@nan 0\n", {"finite", "nan"}),
        mesh("VertexIsDamaged", "v 0 0 0\nv 1 0 @@0x\n", {"0x"}),
        mesh("VertexBeyondFloat", "v 0 0 @@1e39\n", {"1e39"}),
        mesh("VertexWithTwoNumbers", "v 0 0 0\n@@v 1 0\n", {"needs 3 numbers", "got 2"}),
        mesh("IndexPastTheEnd", square + "f 1 2 @@5\n", {"vertex index 5", "has 4"}),
        mesh("IndexZero", square + "f 1 @@0 3\n", {"other than 0"}),
        mesh("IndexBeforeTheStart", square + "f 1 2 @@-5\n", {"-5"}),
        mesh("IndexBeyondInteger", square + "f 1 2 @@99999999999\n", {"99999999999"}),
        mesh("MissingNormal", square + "f @@1//1 2//1 3//1\n", {"normal"}),
        mesh("CornerWithFourParts", square + "vt 0 0\nvn 0 0 1\nf 1 2 @@3/1/1/1\n", {"v/vt/vn"}),
        mesh("FaceWithTwoCorners", square + "@@f 1 2\n", {"at least 3", "got 2"}),
        mesh("ConcavePolygon", square + "v 0.1 0.5 0\n@@f 1 2 5 3 4\n", {"concave"}),
        mesh("NormalsForSomeCorners", square + "vn 0 0 1\nf 1//1 2//1 3//1\n@@f 1 3 4\n", {"face_normals"}),
        mesh("NormalOfLengthZero", square + "vn 0 0 0\n@@f 1//1 2//1 3//1\n", {"length zero"}),
        mesh("NormalsCancel", square + "f 1 2 3\nf 1 3 2\n", {"cancel out", "face_normals"}),
    };
}

class MeshError : public testing::TestWithParam<BadText> {};

TEST_P(MeshError, NamesTheCauseAndItsPlace) { expectRefused(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Obj, MeshError, testing::ValuesIn(badMeshes()), nameOfBadText);

}  // namespace
}  // namespace parhelion::test
