#include <gtest/gtest.h>

#include <vector>

#include "reference/geometry/intersection.h"
#include "reference/reference_renderer.h"
#include "support/hand_scene.h"

namespace parhelion::reference {
namespace {

using test::HandScene;

/// The shape the ray is inside of, from its start through every change of it until it hits something or nothing.
std::vector<std::uint32_t> insides(const SceneView<float>& scene, Ray<float> ray) {
    std::vector<std::uint32_t> visited{ray.inside};
    for (;;) {
        const Hit<float> hit = closestHit(scene, ray);
        if (!hit.found() || !hit.isNull) return visited;
        const float before = ray.tMin;
        EXPECT_TRUE(crossBoundary(scene, hit, ray));
        EXPECT_GE(ray.tMin, before);
        // Through an edge, both of its triangles are crossed: the second changes nothing.
        if (ray.inside != visited.back()) visited.push_back(ray.inside);
        if (visited.size() > 100) return visited;
    }
}

Ray<float> alongX(glm::vec3 origin, std::uint32_t inside = kNone) {
    Ray<float> ray;
    ray.origin = origin;
    ray.direction = {1, 0, 0};
    ray.inside = inside;
    return ray;
}

constexpr std::uint32_t kOuter = 0, kInner = 1;

TEST(ReferenceInside, NestedMediaAreEnteredAndLeftInOrder) {
    HandScene scene;
    const std::uint32_t medium = scene.addHomogeneous(1, glm::vec3(1));
    scene.addNull(medium);
    scene.addNull(medium, kOuter);
    scene.addSphere({0, 0, 0}, 1, kInner);
    scene.addBox({-2, -2, -2}, {2, 2, 2}, kOuter);
    const SceneView<float> view(scene.scene);
    const std::vector<std::uint32_t> through{kNone, kOuter, kInner, kOuter, kNone};
    EXPECT_EQ(insides(view, alongX({-5, 0, 0})), through);
    EXPECT_EQ(insides(view, alongX({-0.5f, 0, 0}, kInner)), (std::vector<std::uint32_t>{kInner, kOuter, kNone}));
    EXPECT_EQ(insides(view, alongX({-1.5f, 0, 0}, kOuter)),
              (std::vector<std::uint32_t>{kOuter, kInner, kOuter, kNone}));
}

TEST(ReferenceInside, NestedMediaMayTouch) {
    // The inner box shares the face x = -2 and x = 2 with the outer one.
    HandScene scene;
    const std::uint32_t medium = scene.addHomogeneous(1, glm::vec3(1));
    scene.addNull(medium);
    scene.addNull(medium, kOuter);
    scene.addBox({-2, -2, -2}, {2, 2, 2}, kOuter);
    scene.addBox({-2, -1, -1}, {2, 1, 1}, kInner);
    const SceneView<float> view(scene.scene);
    const auto visited = insides(view, alongX({-5.1f, 0.1f, 0.2f}));
    ASSERT_GE(visited.size(), 3u);
    EXPECT_EQ(visited.back(), kNone);
    EXPECT_EQ(std::count(visited.begin(), visited.end(), kInner), 1);
}

TEST(ReferenceInside, AdjacentMediaFollowEachOther) {
    HandScene scene;
    const std::uint32_t medium = scene.addHomogeneous(1, glm::vec3(1));
    scene.addNull(medium);
    scene.addNull(medium);
    scene.addBox({0, -1, -1}, {1, 1, 1}, 0);
    scene.addBox({1, -1, -1}, {2, 1, 1}, 1);
    const SceneView<float> view(scene.scene);
    for (int i = 0; i < 1000; ++i) {
        const Ray<float> ray = alongX({-1 - 0.00137f * float(i), 0.3f, 0.1f});
        ASSERT_EQ(insides(view, ray), (std::vector<std::uint32_t>{kNone, 0, kNone, 1, kNone})) << i;
    }
}

TEST(ReferenceInside, MeshesAreEnteredAndLeft) {
    HandScene scene;
    const std::uint32_t medium = scene.addHomogeneous(1, glm::vec3(1));
    scene.addTriangles(test::icosphere(2), scene.addNull(medium));
    const SceneView<float> view(scene.scene);
    for (int i = -9; i <= 9; ++i)
        EXPECT_EQ(insides(view, alongX({-3, 0.1f * float(i), 0.0123f})), (std::vector<std::uint32_t>{kNone, 0, kNone}))
            << i;
}

TEST(ReferenceInside, OverlappingMediaEndThePathAndAreCounted) {
    HandScene scene;
    const std::uint32_t medium = scene.addHomogeneous(1, glm::vec3(1));
    scene.addBox({-1, -1, -4}, {1, 1, -2}, scene.addNull(medium));
    scene.addBox({-1, -1, -5}, {1, 1, -3}, scene.addNull(medium));
    RenderSettings settings;
    settings.sampleCount = 64;
    const Film film = render<float>(scene.scene, settings);
    EXPECT_GT(film.counters[shared::kCounterLoopTruncated], 0u);
}

/// A medium box of albedo 1 that stands on a white floor, under a white sky, with a black floor below. Without
/// leaks through the floor every path returns exactly 1.
CompiledScene mediumOnFloor(float floorHeight) {
    HandScene scene;
    scene.lookAt({0.1f, 0.2f, -1}, {16, 16});
    const std::uint32_t white = scene.addDiffuse(glm::vec3(1)), black = scene.addDiffuse(glm::vec3(0), 2);
    const std::uint32_t fog = scene.addNull(scene.addHomogeneous(0.5f, glm::vec3(1)));
    scene.addQuad({-1e6f, -1e6f, floorHeight}, {2e6f, 0, 0}, {0, 2e6f, 0}, white);
    scene.addQuad({-1e7f, -1e7f, floorHeight - 1}, {2e7f, 0, 0}, {0, 2e7f, 0}, black);
    scene.addBox({-2, -2, floorHeight}, {2, 2, floorHeight + 2}, fog);
    scene.setEnvironment(glm::vec3(1));
    return scene.scene;
}

TEST(ReferenceInside, NothingLeaksThroughAFloorUnderAMedium) {
    for (const float height : {-3.0f, -3.1f, -4.7f}) {
        RenderSettings settings;
        settings.sampleCount = 200;
        const CompiledScene scene = mediumOnFloor(height);
        const Film film = render<float>(scene, settings);
        int lost = 0;
        // The floor ends at 1e6: 1e-6 of the directions from a height of 2 pass beside it, onto black.
        for (const shared::FilmPixel& pixel : film.pixels)
            lost += int(std::lround(double(settings.sampleCount) - test::estimate(pixel, 1).mean));
        EXPECT_LE(lost, 3) << "of " << film.pixels.size() * settings.sampleCount << " paths, floor at " << height;
        EXPECT_EQ(film.counters[shared::kCounterLoopTruncated], 0u);
    }
}

}  // namespace
}  // namespace parhelion::reference
