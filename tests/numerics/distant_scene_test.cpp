#include <gtest/gtest.h>

#include <cstring>

#include "unit/compile_fixtures.h"

// Covers H42: at 1e6 units from the origin floats are 0.06 apart.
namespace parhelion {
namespace {

using namespace fixtures;

SceneDescription sceneAt(const glm::dvec3& offset) {
    SceneDescription description = scene();
    const glm::dmat4 moved = translation(offset);
    description.camera.toWorld = moved * description.camera.toWorld;
    description.shapes = {boundary(cube("box", {0.25, -0.5, 0}, {1, 0.5, 2}), 0),
                          rectangle("floor", glm::rotate(glm::dmat4(1.0), 0.3, glm::dvec3(1, 2, 3))),
                          emissive(sphere("lamp", {2, 1, 3}, 0.125), {1, 2, 3}),
                          tetrahedron("mesh", translation({-4, 0, 0}))};
    for (ShapeDescription& shape : description.shapes) shape.toWorld = moved * shape.toWorld;
    description.media = {gridMedium("m", DensityGrid::fromDense({2, 3, 5}, std::vector<float>(30, 0.5f)))};
    description.media[0].density->toWorld = moved * scaling({2, 1, 4});
    EmitterDescription bulb;
    bulb.type = EmitterDescription::Type::Point;
    bulb.vector = offset + glm::dvec3(0.5, 4, -0.25);
    description.emitters = {bulb};
    return description;
}

template <typename T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(DistantScene, CompilesToTheBitsOfTheCentredOne) {
    // Every translation here is a multiple of 2^-3, so that adding the offset in double is exact and any difference
    // is a rounding to float before the subtraction.
    const CompiledScene centred = compileScene(sceneAt({0, 0, 0}));
    for (const glm::dvec3 offset : {glm::dvec3(1e6, 0, 0), glm::dvec3(-1e6, 2e6, 3e6)}) {
        const CompiledScene distant = compileScene(sceneAt(offset));
        EXPECT_EQ(std::memcmp(&centred.constants, &distant.constants, sizeof(centred.constants)), 0);
        EXPECT_TRUE(sameBits(centred.triangles, distant.triangles));
        EXPECT_TRUE(sameBits(centred.bvhNodes, distant.bvhNodes));
        EXPECT_EQ(distant.worldOrigin, centred.worldOrigin + offset);
    }
}

TEST(DistantScene, RoundingBeforeSubtractingWouldBeSeen) {
    // The seeded defect: the offset scene as floats.
    SceneDescription rounded = sceneAt({1e6, 0, 0});
    for (ShapeDescription& shape : rounded.shapes)
        shape.toWorld = glm::dmat4(glm::mat4(shape.toWorld * translation({0.01, 0, 0})));
    SceneDescription exact = sceneAt({1e6, 0, 0});
    for (ShapeDescription& shape : exact.shapes) shape.toWorld = shape.toWorld * translation({0.01, 0, 0});
    EXPECT_GT(
        glm::distance(compileScene(rounded).constants.quads[0].corner, compileScene(exact).constants.quads[0].corner),
        1e-3f);
}

}  // namespace
}  // namespace parhelion
