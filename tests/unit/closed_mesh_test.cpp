#include <fmt/format.h>
#include <gtest/gtest.h>

#include "compile/placed_shape.h"
#include "unit/compile_fixtures.h"

// Meshes around media: closed, facing outwards, each of their parts apart from the others.
namespace parhelion {
namespace {

using namespace fixtures;

const glm::dvec3 kUnit(1.0);

Mesh cubeMesh(bool split = false) {
    Mesh mesh;
    addCube(mesh, {}, kUnit, split);
    return mesh;
}

ShapeDescription fog(Mesh mesh) { return boundary(meshOf("fog", std::move(mesh)), 0); }

SceneDescription sceneOf(ShapeDescription shape) {
    SceneDescription description = scene();
    description.shapes = {std::move(shape)};
    description.media = {medium("a")};
    return description;
}

std::string refusalOf(Mesh mesh) { return inputErrorOf(sceneOf(fog(std::move(mesh)))); }

std::vector<std::string> notesOf(Mesh mesh) { return compileScene(sceneOf(fog(std::move(mesh)))).notes; }

void expectRefused(const Mesh& mesh, const std::string& why) {
    const std::string message = refusalOf(mesh);
    EXPECT_TRUE(contains(message, why)) << message;
    EXPECT_TRUE(contains(message, "fog.xml:7:5: mesh \"fog\"")) << message;
}

void expectOneNote(const Mesh& mesh, const std::string& what) {
    const std::vector<std::string> notes = notesOf(mesh);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_TRUE(contains(notes[0], what)) << notes[0];
}

// Split vertices, as normals and texture coordinates need them; -0 for 0; a triangle without area within an edge.
TEST(ClosedMesh, TakesWhatExportersWrite) {
    EXPECT_EQ(notesOf(cubeMesh()).size(), 0u);
    EXPECT_EQ(notesOf(cubeMesh(true)).size(), 0u);
    Mesh zeros = tetrahedron("t").mesh;
    zeros.positions.push_back(-zeros.positions[0]);
    zeros.triangles[0].x = 4;
    EXPECT_EQ(notesOf(zeros).size(), 0u);
    Mesh doubled = cubeMesh();
    doubled.triangles.insert(doubled.triangles.end(), {{0, 1, 1}, {0, 0, 0}});
    EXPECT_EQ(refusalOf(doubled), "");
}

TEST(ClosedMesh, RefusesHolesWithTheirCountAndPlace) {
    Mesh one = cubeMesh();
    one.triangles.pop_back();
    expectRefused(one, "3 edges with one triangle, one of them from (-1, -1, 1) to (");
    Mesh face = cubeMesh(true);
    face.triangles.resize(10);
    expectRefused(face, "4 edges with one triangle");
    Mesh fin = cubeMesh();
    fin.positions.emplace_back(0, 0, 5);
    fin.triangles.emplace_back(0, 1, 8);
    expectRefused(fin, "2 edges with one triangle and 1 with three or more");
    expectRefused(rectangle("r").mesh, "closed mesh");
}

// A seam that rounding opened closes on the same floats; a gap that is wider is a hole.
TEST(ClosedMesh, ClosesGapsOfRounding) {
    Mesh seam = cubeMesh(true);
    for (std::size_t i = 0; i < 4; ++i) seam.positions[i] += glm::dvec3(1e-7, -2e-7, 1e-7);
    expectOneNote(seam, "4 of its vertices were moved");
    const PlacedShape placed = placeShape(fog(seam), {});
    for (std::size_t i = 0; i < 4; ++i) {
        std::size_t same = 0;
        for (const glm::dvec3& v : placed.vertices) same += v == placed.vertices[i];
        EXPECT_EQ(same, 3u) << "the corners of three faces";
    }
    for (std::size_t i = 0; i < 4; ++i) seam.positions[i].x += 1e-4;
    expectRefused(seam, "edges with one triangle");
    // Far from its own origin, where the sixth digit is as large as the hole.
    Mesh far = cubeMesh();
    far.triangles.pop_back();
    for (glm::dvec3& position : far.positions) position.x += 1e6;
    expectRefused(far, "3 edges with one triangle");
}

// Two triangles of one neighbour along an edge of another: no edge has a partner of its length, yet nothing is open.
TEST(ClosedMesh, TakesEdgesThatSeveralShorterOnesClose) {
    Mesh mesh = tetrahedron("t").mesh;  // its triangle 1, 2, 3 is cut at the middle of the edge from 1 to 2
    mesh.positions.emplace_back(0.5, 0.5, 0);
    mesh.triangles[3] = {1, 4, 3};
    mesh.triangles.emplace_back(4, 2, 3);
    EXPECT_EQ(notesOf(mesh).size(), 0u);
    mesh.positions[4] = {0.5, 0.6, 0};
    expectRefused(mesh, "3 edges with one triangle");
}

TEST(ClosedMesh, TurnsTrianglesWoundAgainstTheirNeighbours) {
    const auto trianglesOf = [](const Mesh& mesh) { return compileScene(sceneOf(fog(mesh))).triangles; };
    for (const std::size_t which : {0u, 5u, 11u}) {
        Mesh mesh = cubeMesh(which == 5);
        const auto right = trianglesOf(mesh);
        std::swap(mesh.triangles[which].y, mesh.triangles[which].z);
        expectOneNote(mesh, "1 of its 12 triangles were turned");
        EXPECT_EQ(trianglesOf(mesh).size(), right.size());
        EXPECT_GT(placeShape(fog(mesh), {}).volume, 7.999);
    }
    // Most of them inwards, some outwards: the outside is outside.
    Mesh most;
    addCube(most, {}, kUnit, false, /*inwards*/ true);
    std::swap(most.triangles[3].y, most.triangles[3].z);
    EXPECT_NEAR(placeShape(fog(most), {}).volume, 8.0, 1e-12);
    expectOneNote(most, "turned");
}

TEST(ClosedMesh, RefusesWhatIsInsideOutAsAWhole) {
    Mesh mesh;
    addCube(mesh, {}, kUnit, false, /*inwards*/ true);
    expectRefused(mesh, "try flip_normals");
    ShapeDescription flipped = fog(mesh);
    flipped.flipNormals = true;
    EXPECT_EQ(inputErrorOf(sceneOf(flipped)), "");
    EXPECT_GT(placeShape(flipped, {}).volume, 0.0);
}

/// A Moebius strip of `n` quadrilaterals, closed by a fan from its one edge: a projective plane.
Mesh oneSided(unsigned n) {
    Mesh mesh;
    for (unsigned i = 0; i < n; ++i) {
        const double turn = 2.0 * 3.14159265358979 * i / n;
        const glm::dvec3 out(std::cos(turn), std::sin(turn), 0.0);
        const glm::dvec3 across = 0.3 * (std::cos(turn / 2) * out + std::sin(turn / 2) * glm::dvec3(0, 0, 1));
        mesh.positions.insert(mesh.positions.end(), {out - across, out + across});
    }
    mesh.positions.emplace_back(0, 0, 3);
    for (unsigned i = 0; i < n; ++i) {
        unsigned a = 2 * i, b = a + 1, c = 2 * ((i + 1) % n), d = c + 1;
        if (i + 1 == n) std::swap(c, d);  // half a turn on, its edges change places
        mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {b, c, d}, {a, 2 * n, c}, {b, d, 2 * n}});
    }
    return mesh;
}

TEST(ClosedMesh, RefusesSurfacesWithOneSide) { expectRefused(oneSided(24), "two sides"); }

TEST(ClosedMesh, TakesHolesAndPartsBesideEachOther) {
    Mesh mesh;
    addCube(mesh, {}, kUnit);
    addCube(mesh, {}, 0.5 * kUnit, true, /*inwards*/ true);  // a hole
    addCube(mesh, {}, 0.2 * kUnit);                          // fog within it
    addCube(mesh, {5, 0, 0}, kUnit);                         // apart
    addCube(mesh, {5, 2, 0}, kUnit, true);                   // shares a face with that
    addCube(mesh, {7, 2, 2}, kUnit);                         // shares an edge
    EXPECT_EQ(notesOf(mesh).size(), 0u);
    EXPECT_NEAR(placeShape(fog(mesh), {}).volume, 8.0 - 1.0 + 0.064 + 3 * 8.0, 1e-12);
}

TEST(ClosedMesh, TurnsAPartThatIsInsideOut) {
    Mesh mesh;
    addCube(mesh, {}, 2.0 * kUnit);
    addCube(mesh, {5, 0, 0}, kUnit, false, /*inwards*/ true);
    expectOneNote(mesh, "12 of its 24 triangles were turned");
    EXPECT_NEAR(placeShape(fog(mesh), {}).volume, 64.0 + 8.0, 1e-12);
}

TEST(ClosedMesh, RefusesPartsThatOverlap) {
    const auto pair = [](const glm::dvec3& center, const glm::dvec3& halfSize) {
        Mesh mesh;
        addCube(mesh, {}, kUnit);
        addCube(mesh, center, halfSize);
        return mesh;
    };
    expectRefused(pair({1.9, 1.9, 1.9}, kUnit), "parts that overlap, near (");  // a corner in a corner
    expectRefused(pair({1, 0, 0}, kUnit), "parts that overlap");                // no two triangles pierce each other
    expectRefused(pair({}, 0.5 * kUnit), "parts that overlap");                 // within, and facing outwards as well
    expectRefused(pair({0, 0, 0}, {0.1, 0.1, 9}), "parts that overlap");        // right through
}

TEST(ClosedMesh, NotesThatAPartOverlapsItself) {
    Mesh mesh = cubeMesh();
    mesh.triangles.erase(mesh.triangles.end() - 2, mesh.triangles.end());  // the +z face, whose middle is pulled down
    mesh.positions.emplace_back(0.1, 0.2, -3);
    mesh.triangles.insert(mesh.triangles.end(), {{4, 5, 8}, {5, 7, 8}, {7, 6, 8}, {6, 4, 8}});
    expectOneNote(mesh, "overlaps itself near (");
}

// Only boundaries of media need any of this.
TEST(ClosedMesh, LeavesOtherMeshesAlone) {
    Mesh mesh = cubeMesh();
    mesh.triangles.pop_back();
    SceneDescription description = sceneOf(meshOf("opaque", mesh));
    EXPECT_EQ(inputErrorOf(description), "");
    description.shapes[0].bsdf.type = BsdfDescription::Type::Null;
    EXPECT_EQ(inputErrorOf(description), "");
}

}  // namespace
}  // namespace parhelion
