// OBJ files: topology, and normals against Mitsuba 3.9.1's.
#include "scene/obj_mesh.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "support/paths.h"
#include "support/temporary_folder.h"

namespace parhelion::test {
namespace {

// Mitsuba computes in single precision: a few roundings of unit vectors.
constexpr double kSinglePrecision = 1e-6;

Mesh readText(const std::string& text, const ObjOptions& options = {}) {
    const TemporaryFolder folder;
    return readObjMesh(folder.write("mesh.obj", text), {}, options);
}

void expectNear(glm::dvec3 actual, glm::dvec3 expected, double tolerance) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(actual[axis], expected[axis], tolerance) << "axis " << axis;
}

/// A horizontal and a vertical triangle that share the edge 0-2, at angles of 90 degrees and 90, 63 and 72.
const std::string kFold = "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 3\nf 1 2 3\nf 1 3 4\n";

TEST(ObjMesh, SmoothNormalsAreWeightedByAngleAsMitsubas) {
    const Mesh mesh = readText(kFold);
    ASSERT_EQ(mesh.normals.size(), 4u);
    expectNear(mesh.normals[0], {0.7071068, 0, 0.7071068}, kSinglePrecision);
    expectNear(mesh.normals[1], {0, 0, 1}, kSinglePrecision);
    expectNear(mesh.normals[2], {0.7483351, 0, 0.663321}, kSinglePrecision);  // weights by area would give .83, .55
    expectNear(mesh.normals[3], {1, 0, 0}, kSinglePrecision);
}

TEST(ObjMesh, SmoothNormalsAreThoseOfTheTransformedMesh) {
    // Mitsuba transforms first, so that uneven scale changes the angles and mirroring turns the winding. The mesh
    // keeps them in its own space, where its user applies the inverse transpose.
    const struct {
        glm::dvec3 scale, expected;
    } cases[] = {{{3, 1, 1}, {0.6642395, 0, 0.7475199}}, {{-1, 1, 1}, {0.7483351, 0, -0.663321}}};
    for (const auto& [scale, expected] : cases) {
        const glm::dmat4 toWorld = glm::scale(glm::dmat4(1.0), scale);
        const Mesh mesh = readText(kFold, {.toWorld = toWorld});
        const glm::dmat3 normalToWorld = glm::transpose(glm::inverse(glm::dmat3(toWorld)));
        expectNear(glm::normalize(normalToWorld * mesh.normals[2]), expected, kSinglePrecision);
    }
}

TEST(ObjMesh, FaceNormalsLeaveNone) {
    EXPECT_TRUE(readText(kFold, {.faceNormals = true}).normals.empty());
    EXPECT_TRUE(
        readText("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n", {.faceNormals = true}).normals.empty());
}

TEST(ObjMesh, NormalsOfTheFileAreKeptAndNormalised) {
    const Mesh mesh = readText("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 3 4\nf 1//1 2//1 3//1\n");
    for (const glm::dvec3& normal : mesh.normals) expectNear(normal, {0, 0.6, 0.8}, kSinglePrecision);
}

TEST(ObjMesh, TextureSeamsSplitVertices) {
    const Mesh mesh =
        readText("v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 3\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 1/2 3/3 4/1\n");
    ASSERT_EQ(mesh.positions.size(), 5u);  // as Mitsuba: the first corner has two texture coordinates, the third one
    expectNear(mesh.normals[0], {0, 0, 1}, kSinglePrecision);
    expectNear(mesh.normals[3], {1, 0, 0}, kSinglePrecision);
    EXPECT_EQ(mesh.triangles[1], glm::uvec3(3, 2, 4));
}

TEST(ObjMesh, TextureCoordinatesAreFlippedUnlessAskedNot) {
    const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.25\nf 1/1 2/1 3/1\n";
    EXPECT_EQ(readText(text).uvs.at(0), glm::dvec2(0.25, 0.75));
    EXPECT_EQ(readText(text, {.flipTexCoords = false}).uvs.at(0), glm::dvec2(0.25, 0.25));
    EXPECT_TRUE(readText(kFold).uvs.empty());
}

TEST(ObjMesh, PolygonsBecomeFansAboutTheirFirstCorner) {
    const Mesh mesh = readText("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 2 0\nv -1 1 0\nf 1 2 3 4 5\n");
    const std::vector<glm::uvec3> expected{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    EXPECT_EQ(mesh.triangles, expected);
}

TEST(ObjMesh, NegativeIndicesCountBackwards) {
    const Mesh mesh = readText("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\n");
    ASSERT_EQ(mesh.positions.size(), 3u) << "vertices that no face uses are dropped";
    EXPECT_EQ(mesh.positions[0], glm::dvec3(0, 0, 0));
    EXPECT_EQ(mesh.positions[2], glm::dvec3(0, 1, 0));
}

TEST(ObjMesh, DegenerateTrianglesAreKept) {
    const Mesh mesh = readText("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 4 4 4\n");
    EXPECT_EQ(mesh.triangles.size(), 3u);
    expectNear(mesh.normals[0], {0, 0, 1}, kSinglePrecision);
}

TEST(ObjMesh, OtherLinesAndLineEndsDoNotMatter) {
    const Mesh mesh = readText(
        "# made by hand\r\nmtllib none.mtl\r\no thing\r\nv 0 0 0 1.0\r\n  v\t1 0 0\r\nv 0 +1 0 0.5 0.5 0.5\r\ng a\r\n"
        "usemtl red\r\ns off\r\nl 1 2\r\nf 1 2 3");
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.positions[2], glm::dvec3(0, 1, 0));
}

TEST(ObjMesh, MatchesMitsubaOnTheBunny) {
    const std::filesystem::path file =
        std::filesystem::path(test::projectFolder()) / "../shared/data/meshes/stanford-bunny.obj";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file;
    const Mesh mesh = readObjMesh(file, {}, {});
    EXPECT_EQ(mesh.positions.size(), 34834u);
    EXPECT_EQ(mesh.triangles.size(), 69451u);
    // Mitsuba's vertex 1000 and the next, in the order the faces name them first. Its triangles are small: edges of
    // 1e-3 at distance 0.1 lose 100 * 2^-24 of their direction, ten triangles average it.
    const glm::dvec3 position(-0.0017160000279545784, 0.13131600618362427, 0.010483999736607075);
    const glm::dvec3 normal(-0.09574353694915771, 0.9951897263526917, -0.020750252529978752);
    bool found = false;
    for (std::size_t i = 0; i < mesh.positions.size() && !found; ++i) {
        found = glm::distance(mesh.positions[i], position) < 1e-7;
        if (found) expectNear(mesh.normals[i], normal, 1e-5);
    }
    EXPECT_TRUE(found);
}

}  // namespace
}  // namespace parhelion::test
