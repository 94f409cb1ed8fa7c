#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "unit/compile_fixtures.h"

namespace parhelion {
namespace {

using namespace fixtures;

glm::vec3 triangleNormal(const CompiledScene& scene, std::size_t triangle) {
    const glm::vec4* t = &scene.triangles[3 * triangle];
    return glm::cross(glm::vec3(t[1]) - glm::vec3(t[0]), glm::vec3(t[2]) - glm::vec3(t[0]));
}

glm::vec3 triangleCenter(const CompiledScene& scene, std::size_t triangle) {
    const glm::vec4* t = &scene.triangles[3 * triangle];
    return (glm::vec3(t[0]) + glm::vec3(t[1]) + glm::vec3(t[2])) / 3.0f;
}

CompiledScene compileShape(const ShapeDescription& shape) {
    SceneDescription description = scene();
    description.shapes = {shape};
    return compileScene(description);
}

TEST(CompiledShapes, RectangleBecomesAQuadSeenFromTheCamera) {
    const CompiledScene compiled = compileShape(rectangle("r", translation({1, 2, 3}) * scaling({2, 3, 1})));
    ASSERT_EQ(compiled.constants.quadCount, 1u);
    const shared::Quad& quad = compiled.constants.quads[0];
    // All values are small integers and fractions of them: exact.
    EXPECT_EQ(quad.corner, glm::vec3(-1, -1, 13)) << "camera at z = -10";
    EXPECT_EQ(quad.edgeU, glm::vec3(4, 0, 0));
    EXPECT_EQ(quad.edgeV, glm::vec3(0, 6, 0));
    EXPECT_EQ(quad.normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(quad.area, 24.0f);
    const glm::vec3 p = quad.corner + 0.25f * quad.edgeU + 0.5f * quad.edgeV;
    EXPECT_FLOAT_EQ(glm::dot(quad.uFromWorld, p - quad.corner), 0.25f);
    EXPECT_FLOAT_EQ(glm::dot(quad.vFromWorld, p - quad.corner), 0.5f);
    EXPECT_EQ(compiled.worldOrigin, glm::dvec3(0, 0, -10));
}

TEST(CompiledShapes, QuadParametersInvertShearedEdges) {
    glm::dmat4 sheared(1.0);
    sheared[1] = glm::dvec4(0.5, 1.0, 0.25, 0.0);
    const shared::Quad quad = compileShape(rectangle("r", sheared)).constants.quads[0];
    const glm::vec3 p = 0.75f * quad.edgeU + 0.125f * quad.edgeV;
    EXPECT_NEAR(glm::dot(quad.uFromWorld, p), 0.75f, 4 * 0x1p-24);  // three products and two sums of at most 1
    EXPECT_NEAR(glm::dot(quad.vFromWorld, p), 0.125f, 4 * 0x1p-24);
}

TEST(CompiledShapes, QuadNormalsFollowMitsuba) {
    // Mitsuba 3.9.1: the normal goes with the transform, which turns it only along itself.
    ShapeDescription flipped = rectangle("r");
    flipped.flipNormals = true;
    EXPECT_EQ(compileShape(flipped).constants.quads[0].normal, glm::vec3(0, 0, -1));
    EXPECT_EQ(compileShape(rectangle("r", scaling({-1, 1, 1}))).constants.quads[0].normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(compileShape(rectangle("r", scaling({1, 1, -1}))).constants.quads[0].normal, glm::vec3(0, 0, -1));
    EXPECT_EQ(compileShape(flipped).shapes[0].flags, 0u) << "the flip is in the data already";
}

TEST(CompiledShapes, SphereTakesCenterRadiusAndUniformScale) {
    ShapeDescription shape = sphere("s", {1, 2, 3}, 2.0);
    shape.center = {0.5, 0, 0};
    shape.radius = 0.25;
    const CompiledScene compiled = compileShape(shape);
    EXPECT_EQ(compiled.constants.spheres[0].center, glm::vec3(2, 2, 13));
    EXPECT_EQ(compiled.constants.spheres[0].radius, 0.5f);

    shape.toWorld = scaling({1, 1, 1.01});
    EXPECT_TRUE(contains(inputErrorOf([&] {
                             auto d = scene();
                             d.shapes = {shape};
                             return d;
                         }()),
                         "scale every axis"));
}

// As Mitsuba 3.9.1 has them.
TEST(CompiledShapes, SpheresUnderAMirrorTurnInsideOutAndCubesDoNot) {
    EXPECT_EQ(compileShape(sphere("s", {}, 1)).shapes[0].flags, 0u);
    EXPECT_EQ(compileShape(shape(ShapeDescription::Type::Sphere, "s", scaling({-1, 1, 1}))).shapes[0].flags,
              shared::kShapeFlipNormal);
    ShapeDescription both = cube("c", {}, {1, 1, -1});
    both.flipNormals = true;
    EXPECT_EQ(compileShape(both).shapes[0].flags, shared::kShapeFlipNormal);
    both.flipNormals = false;
    EXPECT_EQ(compileShape(both).shapes[0].flags, 0u);
    both.bsdf.twoSided = true;
    EXPECT_EQ(compileShape(both).shapes[0].flags, shared::kShapeTwoSided);
}

TEST(CompiledShapes, BoxMapsItsCornersToTheUnitCube) {
    const glm::dmat4 toWorld = glm::rotate(translation({3, -1, 2}) * scaling({1, 2, 3}), 0.7, glm::dvec3(1, 2, 3));
    const CompiledScene compiled = compileShape(shape(ShapeDescription::Type::Cube, "c", toWorld));
    ASSERT_EQ(compiled.constants.boxCount, 1u);
    const glm::dvec3 corner(toWorld * glm::dvec4(1, -1, 1, 1));
    const glm::vec3 local =
        compiled.constants.boxes[0].localFromWorld * glm::vec4(glm::vec3(corner - compiled.worldOrigin), 1.0f);
    // Coordinates up to 14 times matrix entries up to 1, four terms: 4 * 14 * 2^-24, twice.
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(local[axis], axis == 1 ? -1.0 : 1.0, 1e-5);
}

TEST(CompiledShapes, MeshKeepsWindingAndFlips) {
    const CompiledScene plain = compileShape(tetrahedron("t"));
    ShapeDescription turned = tetrahedron("t");
    turned.flipNormals = true;
    const CompiledScene flipped = compileShape(turned);
    const glm::vec3 middle(0.25f, 0.25f, 10.25f);
    ASSERT_EQ(plain.constants.triangleCount, 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_GT(glm::dot(triangleNormal(plain, i), triangleCenter(plain, i) - middle), 0.0f) << i;
        EXPECT_LT(glm::dot(triangleNormal(flipped, i), triangleCenter(flipped, i) - middle), 0.0f) << i;
    }
    EXPECT_TRUE(plain.vertexNormals.empty());
}

TEST(CompiledShapes, VertexNormalsAreTransformedNormalisedAndOptional) {
    ShapeDescription shape = tetrahedron("t", scaling({1, 1, 2}));
    shape.mesh.normals = {{0, 0, 3}, {0, 1, 1}, {1, 0, 0}, {0, 0, 1}};
    const CompiledScene smooth = compileShape(shape);
    ASSERT_EQ(smooth.vertexNormals.size(), smooth.triangles.size());
    // (0, 1, 1) under the inverse transpose of diag(1, 1, 2) is along (0, 2, 1).
    const glm::vec3 expected = glm::normalize(glm::vec3(0, 2, 1));
    bool found = false;
    for (std::size_t i = 0; i < smooth.triangles.size(); ++i)
        if (glm::vec3(smooth.triangles[i]) == glm::vec3(1, 0, 10)) {
            found = true;
            EXPECT_LT(glm::distance(glm::vec3(smooth.vertexNormals[i]), expected), 4 * 0x1p-24);
        }
    EXPECT_TRUE(found);
    EXPECT_TRUE(smooth.effects.has(Effect::hasVertexNormals));
    shape.faceNormals = true;
    EXPECT_TRUE(compileShape(shape).vertexNormals.empty());
}

TEST(CompiledShapes, DropsTrianglesOfZeroAreaWithANote) {
    ShapeDescription shape = tetrahedron("t");
    shape.mesh.positions.push_back({0.5, 0.5, 0.0});
    shape.mesh.triangles.push_back({1, 1, 2});
    shape.mesh.triangles.push_back({1, 2, 4});  // on the edge from 1 to 2
    const CompiledScene compiled = compileShape(shape);
    EXPECT_EQ(compiled.constants.triangleCount, 4u);
    ASSERT_EQ(compiled.notes.size(), 1u);
    EXPECT_TRUE(contains(compiled.notes[0], "2 triangles of zero area"));
}

TEST(CompiledShapes, BrokenInputIsRefusedWithItsPlace) {
    SceneDescription description = scene();
    description.shapes = {rectangle("flat", scaling({1, 0, 1}))};
    EXPECT_TRUE(contains(inputErrorOf(description), "flat.xml:7:5: rectangle \"flat\": to_world must be invertible"));
    description.shapes = {tetrahedron("t")};
    description.shapes[0].mesh.triangles.push_back({0, 1, 4});
    EXPECT_TRUE(contains(inputErrorOf(description), "one of its 4 vertices; got 4"));
    description.shapes = {tetrahedron("t", scaling(glm::dvec3(1e39)))};
    EXPECT_TRUE(contains(inputErrorOf(description), "single precision"));
    description.shapes = {emissive(boundary(sphere("s", {}, 1), 0), {1, 1, 1})};
    description.media = {medium("m")};
    EXPECT_TRUE(contains(inputErrorOf(description), "area light needs a surface"));
    description.shapes = {boundary(rectangle("r"), 0)};
    EXPECT_TRUE(contains(inputErrorOf(description), "encloses nothing"));
    description.shapes = {boundary(tetrahedron("t"), 0)};
    description.shapes[0].flipNormals = true;
    EXPECT_TRUE(contains(inputErrorOf(description), "outwards"));
}

TEST(CompiledShapes, ManyRectanglesAndCubesBecomeTriangles) {
    SceneDescription description = scene();
    for (int i = 0; i < 30; ++i) description.shapes.push_back(rectangle("r", translation({3.0 * i, 0, 0})));
    description.shapes.push_back(cube("plain", {0, 9, 0}, {1, 1, 1}));
    description.shapes.push_back(boundary(cube("fog", {0, 18, 0}, {1, 1, 1}), 0));
    description.shapes.push_back(emissive(rectangle("light", translation({0, -9, 0})), {1, 1, 1}));
    description.media = {medium("m")};
    const CompiledScene compiled = compileScene(description);
    EXPECT_EQ(compiled.constants.boxCount, 1u) << "the medium boundary";
    EXPECT_EQ(compiled.constants.quadCount, 23u);
    EXPECT_EQ(compiled.constants.triangleCount, 2u * 8 + 12) << "8 rectangles and the plain cube";
    ASSERT_EQ(compiled.constants.lightCount, 1u);
    EXPECT_EQ(compiled.constants.lights[0].type, shared::kLightQuad);
}

TEST(CompiledShapes, TessellatedCubesFaceOutwardsUnlessFlipped) {
    for (const bool flip : {false, true})
        for (const double mirror : {1.0, -1.0}) {
            ShapeDescription shape = emissive(cube("c", {0, 0, 5}, {mirror, 2, 3}), {1, 1, 1});
            shape.flipNormals = flip;
            const CompiledScene compiled = compileShape(shape);
            ASSERT_EQ(compiled.constants.triangleCount, 12u);
            const float side = flip ? -1.0f : 1.0f;
            float doubledArea = 0;
            for (std::size_t i = 0; i < 12; ++i) {
                const glm::vec3 normal = triangleNormal(compiled, i);
                EXPECT_GT(side * glm::dot(normal, triangleCenter(compiled, i) - glm::vec3(0, 0, 15)), 0.0f);
                doubledArea += glm::length(normal);
            }
            EXPECT_FLOAT_EQ(doubledArea, 2 * 2 * (8 + 12 + 24));
        }
}

TEST(CompiledShapes, TooManySpheresAreRefusedWithTheLimit) {
    SceneDescription description = scene();
    for (unsigned i = 0; i <= shared::kMaxSpheres; ++i) description.shapes.push_back(sphere("s", {3.0 * i, 0, 0}, 1));
    EXPECT_TRUE(contains(inputErrorOf(description), "at most 256 spheres"));
}

TEST(CompiledShapes, NullShapesWithoutMediaAreDropped) {
    SceneDescription description = scene();
    description.shapes = {sphere("opaque", {}, 1), sphere("nothing", {5, 0, 0}, 1)};
    description.shapes[1].bsdf.type = BsdfDescription::Type::Null;
    const CompiledScene compiled = compileScene(description);
    EXPECT_EQ(compiled.shapes.size(), 1u);
    EXPECT_EQ(compiled.constants.sphereCount, 1u);
    ASSERT_EQ(compiled.notes.size(), 1u);
    EXPECT_TRUE(contains(compiled.notes[0], "dropped"));
}

TEST(CompiledScene, MemoryIsTheSumOfItsArraysAndLimited) {
    SceneDescription description = scene();
    description.shapes = {tetrahedron("t")};
    const CompiledScene compiled = compileScene(description);
    std::size_t sum = 0;
    for (const ArraySize& array : compiled.arraySizes()) sum += array.bytes;
    EXPECT_EQ(compiled.memoryBytes(), sum);
    EXPECT_EQ(compiled.arraySizes()[3].name, "triangles");
    EXPECT_EQ(compiled.arraySizes()[3].bytes, 4u * 48);
    CompileOptions options;
    options.memoryLimitBytes = 100;
    EXPECT_THROW(compileScene(description, options), RuntimeFailure);
}

}  // namespace
}  // namespace parhelion
