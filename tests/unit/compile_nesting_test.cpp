#include <gtest/gtest.h>

#include "unit/compile_fixtures.h"

namespace parhelion {
namespace {

using namespace fixtures;

SceneDescription sceneWith(std::vector<ShapeDescription> shapes, std::size_t mediumCount = 3) {
    SceneDescription description = scene();
    description.shapes = std::move(shapes);
    for (std::size_t i = 0; i < mediumCount; ++i) description.media.push_back(medium(std::string(1, char('a' + i))));
    return description;
}

glm::dmat4 turned(const glm::dvec3& at, double degrees, const glm::dvec3& axis, const glm::dvec3& halfSize) {
    return glm::rotate(translation(at), glm::radians(degrees), axis) * scaling(halfSize);
}

TEST(MediumNesting, ExteriorIsTheShapeThatProvidesIt) {
    const SceneDescription description =
        sceneWith({boundary(sphere("inner", {0, 0, 0}, 0.5), 1, 0), boundary(cube("outer", {0, 0, 0}, {2, 2, 2}), 0),
                   boundary(sphere("apart", {9, 0, 0}, 1), 0)});
    const CompiledScene compiled = compileScene(description);
    ASSERT_EQ(compiled.shapes.size(), 3u);
    EXPECT_EQ(compiled.shapes[0].exterior, 1u);
    EXPECT_EQ(compiled.shapes[1].exterior, shared::kNone);
    EXPECT_EQ(compiled.shapes[2].exterior, shared::kNone);
    EXPECT_EQ(compiled.constants.mediumCount, 2u);
    EXPECT_EQ(compiled.shapes[1].interior, compiled.shapes[2].interior);
    EXPECT_NE(compiled.shapes[0].interior, compiled.shapes[1].interior);
}

TEST(MediumNesting, ThreeDeepFindsTheInnermost) {
    const CompiledScene compiled = compileScene(sceneWith(
        {boundary(sphere("c", {}, 1), 2, 1), boundary(sphere("a", {}, 3), 0), boundary(sphere("b", {}, 2), 1, 0)}));
    EXPECT_EQ(compiled.shapes[0].exterior, 2u);
    EXPECT_EQ(compiled.shapes[2].exterior, 1u);
}

TEST(MediumNesting, MoreBoundariesThanTheDeviceCanNumberAreRefusedWithAPlace) {
    std::vector<ShapeDescription> shapes;
    for (std::uint32_t i = 0; i <= shared::kMaxBoundaries; ++i)
        shapes.push_back(boundary(sphere("s", {3.0 * i, 0, 0}, 1), 0));
    shapes.back().where.line = 99;
    const std::string message = inputErrorOf(sceneWith(shapes));
    EXPECT_TRUE(contains(message, ":99:") && contains(message, "at most 16383 medium boundaries; got 16384"))
        << message;
}

TEST(MediumNesting, OfTwoProvidersTheInnerOneWins) {
    const ShapeDescription outer = boundary(sphere("outer", {}, 3), 0), inner = boundary(sphere("inner", {}, 2), 0, 0),
                           core = boundary(sphere("core", {}, 1), 1, 0);
    EXPECT_EQ(compileScene(sceneWith({outer, inner, core})).shapes[2].exterior, 1u);
    EXPECT_EQ(compileScene(sceneWith({inner, outer, core})).shapes[2].exterior, 0u);
}

TEST(MediumNesting, OverlapsAreRefusedNamingBoth) {
    const glm::dvec3 unit(1, 1, 1);
    const std::vector<std::pair<ShapeDescription, ShapeDescription>> pairs = {
        {sphere("p", {0, 0, 0}, 1), sphere("q", {1.9, 0, 0}, 1)},
        {cube("p", {0, 0, 0}, unit), cube("q", {1.99, 1.99, 1.99}, unit)},
        {cube("p", {0, 0, 0}, unit),
         shape(ShapeDescription::Type::Cube, "q", turned({2.3, 0, 0}, 45, {0, 0, 1}, unit))},
        {cube("p", {0, 0, 0}, unit), sphere("q", {1.5, 1.5, 0}, 0.71)},
        {cube("p", {0, 0, 0}, unit), sphere("q", {0, 0, 0}, 1.2)},  // pokes out of the faces, not the corners
        {sphere("p", {0, 0, 0}, 1), sphere("q", {0, 0, 0}, 1)}};    // coincident
    for (const auto& [p, q] : pairs) {
        const std::string message = inputErrorOf(sceneWith({boundary(p, 0), boundary(q, 1)}));
        EXPECT_TRUE(contains(message, "\"p\"") && contains(message, "\"q\"") && contains(message, "overlap"))
            << message;
        EXPECT_TRUE(contains(message, "q.xml:7:5"));
    }
}

TEST(MediumNesting, TouchingAndNearbyMediaAreAccepted) {
    const glm::dvec3 unit(1, 1, 1);
    const std::vector<std::pair<ShapeDescription, ShapeDescription>> pairs = {
        {sphere("p", {0, 0, 0}, 1), sphere("q", {2, 0, 0}, 1)},
        {cube("p", {0, 0, 0}, unit), cube("q", {2, 0, 0}, unit)},  // share a face
        {cube("p", {0, 0, 0}, unit), cube("q", {2.0 - 1e-7, 0, 0}, unit)},
        {cube("p", {0, 0, 0}, unit),
         shape(ShapeDescription::Type::Cube, "q", turned({2.42, 0, 0}, 45, {0, 0, 1}, unit))},
        // Bounding boxes and face normals overlap; only the product of two edges separates.
        {shape(ShapeDescription::Type::Cube, "p", turned({0, 0, 0}, 45, {0, 0, 1}, {1, 1, 4})),
         shape(ShapeDescription::Type::Cube, "q", turned({2.9, 0, 0}, 45, {0, 1, 0}, {1, 4, 1}))},
        {cube("p", {0, 0, 0}, unit), sphere("q", {1.5, 1.5, 0}, 0.70)}};  // past the edge
    for (const auto& [p, q] : pairs) EXPECT_EQ(inputErrorOf(sceneWith({boundary(p, 0), boundary(q, 1)})), "");
}

ShapeDescription meshOfCube(const std::string& id, const glm::dvec3& center, const glm::dvec3& half,
                            double degrees = 0.0) {
    Mesh mesh;
    addCube(mesh, {}, {1, 1, 1}, /*split*/ true);
    return meshOf(id, mesh, turned(center, degrees, {0, 0, 1}, half));
}

/// A cube of half size 3 with a cubic hole of half size 2.
ShapeDescription hollowCube(const std::string& id) {
    Mesh mesh;
    addCube(mesh, {}, glm::dvec3(3));
    addCube(mesh, {}, glm::dvec3(2), false, /*inwards*/ true);
    return meshOf(id, mesh);
}

// Meshes by the rule of cubes and spheres.
TEST(MediumNesting, OverlapsOfMeshesAreRefusedNamingBoth) {
    const glm::dvec3 unit(1, 1, 1);
    const std::vector<std::pair<ShapeDescription, ShapeDescription>> pairs = {
        {meshOfCube("p", {}, unit), meshOfCube("q", {1.9, 1.9, 1.9}, unit)},
        {meshOfCube("p", {}, unit), meshOfCube("q", {1, 0, 0}, unit)},  // along its faces: nothing pierces
        {meshOfCube("p", {}, unit), meshOfCube("q", {2.3, 0, 0}, unit, 45)},
        {meshOfCube("p", {}, unit), meshOfCube("q", {}, {0.1, 0.1, 5})},
        {meshOfCube("p", {}, unit), meshOfCube("q", {}, unit)},  // coincident
        {meshOfCube("p", {}, unit), cube("q", {1.9, 1.9, 1.9}, unit)},
        {cube("p", {}, unit), meshOfCube("q", {0, 0, 1.5}, unit)},
        {meshOfCube("p", {}, unit), sphere("q", {}, 1.2)},  // pokes out of the faces
        {sphere("p", {}, 2.1), hollowCube("q")},            // pokes out of its hole
        {sphere("p", {}, 3.5), hollowCube("q")},
        {sphere("p", {1.7, 0, 0}, 1), meshOfCube("q", {}, unit)}};
    for (const auto& [p, q] : pairs) {
        const std::string message = inputErrorOf(sceneWith({boundary(p, 0), boundary(q, 1)}));
        EXPECT_TRUE(contains(message, "\"p\"") && contains(message, "\"q\"") && contains(message, "overlap"))
            << message;
        EXPECT_TRUE(contains(message, "q.xml:7:5") && contains(message, "near (")) << message;
    }
}

TEST(MediumNesting, TouchingAndNestedMeshesAreAccepted) {
    const glm::dvec3 unit(1, 1, 1);
    const std::vector<std::pair<ShapeDescription, ShapeDescription>> apart = {
        {meshOfCube("p", {}, unit), meshOfCube("q", {2, 0, 0}, unit)},    // share a face,
        {meshOfCube("p", {}, unit), meshOfCube("q", {2, 0.7, 0}, unit)},  // a part of one,
        {meshOfCube("p", {}, unit), meshOfCube("q", {2, 2, 0}, unit)},    // an edge,
        {meshOfCube("p", {}, unit), meshOfCube("q", {2, 2, 2}, unit)},    // a corner
        {meshOfCube("p", {}, unit), meshOfCube("q", {2.0 - 1e-7, 0, 0}, unit)},
        {meshOfCube("p", {}, unit), meshOfCube("q", {2.42, 0, 0}, unit, 45)},
        {meshOfCube("p", {}, unit), cube("q", {2, 0, 0}, unit)},
        {meshOfCube("p", {}, unit), sphere("q", {2, 0, 0}, 1)},
        {sphere("p", {}, 2), hollowCube("q")},  // touches its hole from within
        {meshOfCube("p", {}, {2, 2, 2}), hollowCube("q")},
        {cube("p", {}, {2, 2, 2}), hollowCube("q")}};
    for (const auto& [p, q] : apart) EXPECT_EQ(inputErrorOf(sceneWith({boundary(p, 0), boundary(q, 1)})), "");

    const std::vector<std::pair<ShapeDescription, ShapeDescription>> nested = {
        {meshOfCube("in", {}, unit), meshOfCube("out", {}, {2, 2, 2})},
        {meshOfCube("in", {0, 0, 1}, unit), meshOfCube("out", {}, {2, 2, 2})},      // one face in common
        {meshOfCube("in", {}, {1, 1, 0.5}), meshOfCube("out", {0, 0, 0.5}, unit)},  // five
        {sphere("in", {}, 1), meshOfCube("out", {}, unit)},
        {meshOfCube("in", {}, unit), sphere("out", {}, 1.7321)},
        {cube("in", {}, unit), meshOfCube("out", {}, unit * 1.5, 45)},
        {sphere("in", {2.5, 0, 0}, 0.5), hollowCube("out")}};  // in its wall
    for (const auto& [in, out] : nested) {
        const CompiledScene compiled = compileScene(sceneWith({boundary(in, 0, 1), boundary(out, 1)}));
        EXPECT_EQ(compiled.shapes[0].exterior, 1u);
        const std::string unnamed = inputErrorOf(sceneWith({boundary(in, 0), boundary(out, 1)}));
        EXPECT_TRUE(contains(unnamed, "<ref name=\"exterior\" id=\"b\"/>")) << unnamed;
    }
}

TEST(MediumNesting, NestedMediaMustNameTheirExterior) {
    const std::string message =
        inputErrorOf(sceneWith({boundary(cube("outer", {}, {2, 2, 2}), 0), boundary(sphere("inner", {}, 1), 1)}));
    EXPECT_TRUE(contains(message, "inner.xml:7:5")) << message;
    EXPECT_TRUE(contains(message, "<ref name=\"exterior\" id=\"a\"/>")) << message;
    const std::string wrong =
        inputErrorOf(sceneWith({boundary(cube("outer", {}, {2, 2, 2}), 0), boundary(sphere("inner", {}, 1), 1, 2),
                                boundary(sphere("elsewhere", {9, 0, 0}, 1), 2)}));
    EXPECT_TRUE(contains(wrong, "got \"c\"")) << wrong;
}

TEST(MediumNesting, AnExteriorNobodyProvidesIsRefused) {
    EXPECT_TRUE(contains(inputErrorOf(sceneWith({boundary(sphere("s", {}, 1), 0, 1)})), "unbounded"));
    ShapeDescription opaque = sphere("s", {}, 1);
    opaque.exterior = 0;
    EXPECT_TRUE(contains(inputErrorOf(sceneWith({opaque})), "unbounded"));
    EXPECT_EQ(inputErrorOf(sceneWith({opaque, boundary(cube("fog", {}, {0.5, 3, 3}), 0)})), "")
        << "an opaque shape may cut through its medium's boundary";
}

TEST(MediumNesting, AHoleIsKeptAndAnEmptyMediumIsAHole) {
    SceneDescription description =
        sceneWith({boundary(sphere("fog", {}, 3), 0), boundary(sphere("hole", {}, 2), 1, 0),
                   boundary(sphere("vacuum", {}, 1.5), 1, 1), boundary(sphere("more", {}, 1.2), 1, 1),
                   boundary(sphere("core", {}, 1), 2, 1)});
    description.media[1].sigmaT = glm::dvec3(0.0);
    const CompiledScene compiled = compileScene(description);
    ASSERT_EQ(compiled.shapes.size(), 3u) << "vacuum in vacuum is dropped";
    EXPECT_EQ(compiled.shapes[1].interior, shared::kNone);
    EXPECT_EQ(compiled.shapes[1].exterior, 0u);
    EXPECT_EQ(compiled.shapes[2].exterior, 1u) << "what is around the dropped shapes";
    EXPECT_EQ(compiled.constants.mediumCount, 2u);
}

TEST(MediumNesting, EmptyMediaLeaveNothing) {
    SceneDescription description = sceneWith({boundary(sphere("s", {}, 1), 0)}, 1);
    description.media[0].sigmaT = glm::dvec3(0.0);
    const CompiledScene compiled = compileScene(description);
    EXPECT_TRUE(compiled.shapes.empty());
    EXPECT_EQ(compiled.constants.mediumCount, 0u);
    EXPECT_FALSE(compiled.effects.has(Effect::hasMedia));
    EXPECT_FALSE(compiled.notes.empty());
}

TEST(MediumNesting, TheSensorsMediumIsTheOneAroundIt) {
    SceneDescription description =
        sceneWith({boundary(cube("outer", {}, {5, 5, 50}), 0), boundary(sphere("inner", {}, 1), 1, 0)});
    description.camera.mediumWhere = {"camera.xml", 4, 9};
    description.camera.medium = 0;
    EXPECT_EQ(inputErrorOf(description), "");
    description.camera.medium = 1;
    const std::string other = inputErrorOf(description);
    EXPECT_TRUE(contains(other, "camera.xml:4:9") && contains(other, "\"a\" of") && contains(other, "got \"b\""))
        << other;
    description.camera.toWorld = translation({0, 0, -100});
    EXPECT_TRUE(contains(inputErrorOf(description), "no medium; got \"b\""));
}

std::uint32_t insideFrom(const glm::dvec3& camera, const std::vector<ShapeDescription>& shapes) {
    SceneDescription description = sceneWith(shapes);
    description.camera.toWorld = translation(camera);
    return compileScene(description).constants.camera.inside;
}

TEST(CameraMedium, TheInnermostBoundaryWins) {
    const std::vector<ShapeDescription> shapes = {boundary(sphere("inner", {0, 0, 0}, 0.5), 1, 0),
                                                  boundary(cube("outer", {0, 0, 0}, {2, 2, 2}), 0),
                                                  boundary(tetrahedron("mesh", translation({5, 0, 0})), 2)};
    EXPECT_EQ(insideFrom({0.1, 0.2, 0.3}, shapes), 0u);
    EXPECT_EQ(insideFrom({1.5, -1.9, 0.3}, shapes), 1u);
    EXPECT_EQ(insideFrom({5.2, 0.2, 0.2}, shapes), 2u);
    EXPECT_EQ(insideFrom({5.4, 0.4, 0.4}, shapes), shared::kNone) << "within the mesh's bounds only";
    EXPECT_EQ(insideFrom({0, 0, -2}, shapes), shared::kNone) << "on the face is outside";
    EXPECT_EQ(insideFrom({0, 0, -10}, shapes), shared::kNone);
}

TEST(CameraMedium, AnOpaqueRoomFilledWithAMediumHoldsTheCamera) {
    ShapeDescription room = cube("room", {}, {3, 3, 3});
    room.interior = 0;
    EXPECT_EQ(insideFrom({1, 1, 1}, {room}), 0u);

    SceneDescription outside = sceneWith({room});
    const CompiledScene compiled = compileScene(outside);
    EXPECT_EQ(compiled.constants.camera.inside, shared::kNone);
    EXPECT_EQ(compiled.constants.mediumCount, 0u) << "no path gets in";
    EXPECT_EQ(compiled.shapes[0].interior, shared::kNone);
    EXPECT_FALSE(compiled.notes.empty());
}

// Opaque meshes need not be closed: their bounds decide.
TEST(CameraMedium, AnOpaqueMeshAroundItIsItsRoom) {
    Mesh walls;
    addCube(walls, {}, {3, 3, 3});
    walls.triangles.pop_back();
    ShapeDescription room = meshOf("room", walls);
    room.interior = 0;
    SceneDescription description = sceneWith({boundary(sphere("s", {}, 1), 1, 0), room});
    description.camera.toWorld = translation({-2, -1, 0.5});
    const CompiledScene compiled = compileScene(description);
    EXPECT_EQ(compiled.constants.camera.inside, 1u);
    EXPECT_EQ(compiled.shapes[0].exterior, 1u);
}

TEST(CompiledIntegrator, PathIgnoresMediaWithANote) {
    SceneDescription description = sceneWith({boundary(sphere("s", {}, 1), 0), sphere("o", {5, 0, 0}, 1)});
    description.integrator.type = "path";
    const CompiledScene compiled = compileScene(description);
    EXPECT_EQ(compiled.shapes.size(), 1u);
    EXPECT_FALSE(compiled.effects.has(Effect::hasMedia));
    EXPECT_TRUE(contains(compiled.notes.at(0), "volpath"));
}

}  // namespace
}  // namespace parhelion
