#pragma once

#include <vector>

#include "support/hand_scene.h"

/// Scenes of one light, for tests of light sampling alone.
namespace parhelion::test {

/// A sheared quad that faces the origin from above.
inline HandScene quadLight() {
    HandScene scene;
    const std::uint32_t shape = scene.addDiffuse(glm::vec3(0));
    const std::uint32_t quad = scene.addQuad({0.4f, -0.5f, 1.1f}, {-0.2f, 1.3f, 0.1f}, {0.9f, 0.3f, 0.2f}, shape);
    scene.addAreaLight(shared::kLightQuad, quad, shape, glm::vec3(1));
    glm::vec3& normal = scene.scene.constants.quads[0].normal;
    if (normal.z > 0) normal = -normal;
    return scene;
}

/// At distance 2 from the origin.
inline HandScene sphereLight(float radius) {
    HandScene scene;
    const std::uint32_t shape = scene.addDiffuse(glm::vec3(0));
    scene.addAreaLight(shared::kLightSphere, scene.addSphere({0, 0, 2}, radius, shape), shape, glm::vec3(1));
    return scene;
}

/// Base of the right triangles of meshLight; number i is i + 1 high and starts at x = i.
inline constexpr float kTriangleBase = 0.9f;

/// Vertices of triangle i.
inline std::vector<glm::vec3> triangleVertices(int i) {
    const auto x = float(i);
    return {{x, 0, 2}, {x, x + 1, 2}, {x + kTriangleBase, 0, 2}};
}

/// A mesh of four right triangles of areas 1 : 2 : 3 : 4 side by side, facing the origin.
inline HandScene meshLight() {
    HandScene scene;
    std::vector<glm::vec3> vertices;
    for (int i = 0; i < 4; ++i)
        for (const glm::vec3& vertex : triangleVertices(i)) vertices.push_back(vertex);
    scene.addTriangles(vertices, scene.addDiffuse(glm::vec3(0)));
    scene.addMeshLight(0, glm::vec3(1));
    return scene;
}

}  // namespace parhelion::test
