#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "reference/geometry/intersection.h"
#include "reference/integrator/direct_lighting.h"
#include "reference/sampling/sampler.h"
#include "reference/sampling/warp.h"
#include "support/hand_scene.h"

namespace parhelion::reference {
namespace {

using test::HandScene;

/// Uniform numbers, one after another.
class Numbers {
public:
    explicit Numbers(std::uint32_t seed) : words_(seed, 1, 2, 3) {}
    template <typename Real>
    Real next() {
        words_ = pcg4d(words_);
        return toUniform<Real>(words_.x);
    }
    template <typename Real>
    Vec3<Real> direction() {
        const Real a = next<Real>();
        return glm::normalize(uniformSphere(Vec2<Real>(a, next<Real>())));
    }
    template <typename Real>
    Vec3<Real> point(Real size) {
        const Real a = next<Real>(), b = next<Real>();
        return (Vec3<Real>(a, b, next<Real>()) * Real(2) - Real(1)) * size;
    }

private:
    glm::uvec4 words_;
};

template <typename Real>
Ray<Real> rayFrom(const Vec3<Real>& origin, const Vec3<Real>& direction, std::uint32_t inside = kNone) {
    Ray<Real> ray;
    ray.origin = origin;
    ray.direction = glm::normalize(direction);
    ray.inside = inside;
    return ray;
}

// H39: rays along an axis, on the faces' planes, inside and outside, agree with the answer known without division.
TEST(ReferenceBox, AxisParallelRaysHaveExactIntervals) {
    const Box<float> box{Affine<float>(glm::mat4x3(1.0f)), 0, false};
    for (int axis = 0; axis < 3; ++axis)
        for (const float y : {-1.0001f, -1.0f, -0.5f, 0.0f, 1.0f, 1.0001f})
            for (const float z : {-2.0f, -1.0f, -0.0f, 1.0f})
                for (const float side : {-1.0f, 1.0f}) {
                    glm::vec3 origin, direction(0.0f);
                    origin[axis] = -3 * side;
                    origin[(axis + 1) % 3] = y;
                    origin[(axis + 2) % 3] = z;
                    direction[axis] = side;
                    const auto interval = boxInterval(box, origin, direction);
                    ASSERT_EQ(interval.has_value(), std::abs(y) <= 1 && std::abs(z) <= 1);
                    if (!interval) continue;
                    EXPECT_EQ(interval->t0, 2.0f);
                    EXPECT_EQ(interval->t1, 4.0f);
                }
}

TEST(ReferenceSphere, FarSpheresKeepTheirInterval) {
    // Seen from 1e4 radii, b^2 - c would leave 4 digits of the radius.
    const Sphere<float> sphere{{0, 0, 1e4f}, 1, 0, false};
    const glm::vec3 direction = glm::normalize(glm::vec3(5e-5f, 0, 1));
    const glm::dvec3 exactDirection(direction);
    const double middle = 1e4 * exactDirection.z;
    const double miss = glm::length(glm::dvec3(0, 0, 1e4) - middle * exactDirection);
    const auto interval = sphereInterval(sphere, glm::vec3(0), direction);
    ASSERT_TRUE(interval);
    // t is rounded to 2^-24 * 1e4 = 6e-4, at each end.
    EXPECT_NEAR(interval->t1 - interval->t0, 2 * std::sqrt(1 - miss * miss), 3e-3);
}

TEST(ReferenceTriangle, FindsDistanceAndBarycentrics) {
    const glm::dvec3 v0{0, 0, 2}, v1{1, 0, 2}, v2{0, 1, 3};
    const glm::dvec3 direction = glm::normalize(0.5 * v0 + 0.3 * v1 + 0.2 * v2);
    const auto hit = intersectTriangle(rayShear(glm::dvec3(0), direction), v0, v1, v2);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, glm::length(0.5 * v0 + 0.3 * v1 + 0.2 * v2), 1e-14);
    EXPECT_NEAR(hit->b1, 0.3, 1e-14);
    EXPECT_NEAR(hit->b2, 0.2, 1e-14);
    // From behind as well.
    EXPECT_TRUE(intersectTriangle(rayShear(4.0 * direction, -direction), v0, v1, v2));
}

TEST(ReferenceTriangle, RaysThroughSharedEdgesHit) {  // H47
    // Rays aimed at points of the edges of a closed mesh, from inside: each must hit something.
    HandScene scene;
    scene.addTriangles(test::icosphere(2), scene.addDiffuse(glm::vec3(1)));
    const SceneView<float> view(scene.scene);
    Numbers numbers(1);
    for (std::uint32_t triangle = 0; triangle < scene.scene.constants.triangleCount; ++triangle)
        for (std::uint32_t corner = 0; corner < 3; ++corner)
            for (int i = 0; i < 100; ++i) {
                const float s = numbers.next<float>();
                const glm::vec3 target =
                    view.vertex(triangle, corner) * s + view.vertex(triangle, (corner + 1) % 3) * (1 - s);
                const glm::vec3 origin = numbers.point(0.4f);
                ASSERT_TRUE(closestHit(view, rayFrom(origin, target - origin)).found());
            }
}

TEST(ReferenceBvh, AgreesWithEveryTriangleTried) {
    HandScene scene;
    Numbers numbers(2);
    std::vector<glm::vec3> vertices;
    for (int i = 0; i < 500; ++i) {
        const glm::vec3 center = numbers.point(2.0f);
        for (int corner = 0; corner < 3; ++corner) vertices.push_back(center + numbers.point(0.3f));
    }
    scene.addTriangles(vertices, scene.addDiffuse(glm::vec3(1)));
    const SceneView<float> view(scene.scene);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        glm::vec3 direction = numbers.direction<float>();
        if (i % 4 == 0) direction = glm::vec3(i % 8 == 0, i % 8 != 0, 0);  // axis parallel
        const Ray<float> ray = rayFrom(numbers.point(3.0f), direction);
        Hit<float> best;
        const TriangleRay<float> prepared = rayShear(ray.origin, ray.direction);
        for (std::uint32_t t = 0; t < 500; ++t) {
            const auto hit = intersectTriangle(prepared, view.vertex(t, 0), view.vertex(t, 1), view.vertex(t, 2));
            if (hit && hit->t >= 0 && hit->t < best.t) best = {hit->t, view.firstTriangle + t};
        }
        const Hit<float> found = closestHit(view, ray);
        ASSERT_EQ(found.primitive, best.primitive);
        ASSERT_EQ(found.t, best.t);
        hits += found.found();
    }
    EXPECT_GT(hits, 2000);
}

TEST(ReferenceIntersection, LowestIdWinsAmongCoincidentSurfaces) {  // H46
    HandScene scene;
    const std::uint32_t shape = scene.addDiffuse(glm::vec3(1));
    for (int i = 0; i < 3; ++i) scene.addQuad({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, shape);
    const std::vector<glm::vec3> triangle{{-1, -1, -2}, {1, -1, -2}, {-1, 1, -2}};
    scene.addTriangles(
        std::vector<glm::vec3>{triangle[0], triangle[1], triangle[2], triangle[0], triangle[1], triangle[2]}, shape);
    const SceneView<float> view(scene.scene);
    Ray<float> ray = rayFrom(glm::vec3(-0.3f, -0.4f, 0), glm::vec3(0, 0, -1));
    EXPECT_EQ(closestHit(view, ray).primitive, 0u);
    ray.last = 0;
    EXPECT_EQ(closestHit(view, ray).primitive, 1u);
    ray.target = 1;
    EXPECT_EQ(closestHit(view, ray).primitive, 2u);
}

TEST(ReferenceIntersection, HitsAtTheFarBoundDoNotCount) {
    HandScene scene;
    scene.addQuad({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, scene.addDiffuse(glm::vec3(1)));
    const SceneView<float> view(scene.scene);
    Ray<float> ray = rayFrom(glm::vec3(0), glm::vec3(0, 0, -1));
    ray.tMax = 2;
    EXPECT_FALSE(closestHit(view, ray).found());
    ray.tMax = 2.0001f;
    EXPECT_TRUE(closestHit(view, ray).found());
}

TEST(ReferenceIntersection, NothingEscapesAClosedConvexMesh) {  // H41
    // Diffuse bounces inside a unit icosphere: every ray must hit the mesh from its back, again and again.
    HandScene scene;
    scene.addTriangles(test::icosphere(3), scene.addDiffuse(glm::vec3(1)));
    const SceneView<float> view(scene.scene);
    Numbers numbers(3);
    Ray<float> ray = rayFrom(glm::vec3(0.1f, 0.2f, 0.3f), glm::vec3(1, 0, 0));
    for (int bounce = 0; bounce < 1000000; ++bounce) {
        Hit<float> hit = closestHit(view, ray);
        while (hit.near && leavesAside(view, ray, hit)) {
            passHit(view, hit, ray);
            hit = closestHit(view, ray);
        }
        ASSERT_TRUE(hit.found()) << "after " << bounce << " bounces";
        Vertex<float> vertex;
        vertex.surface = surfaceAt(view, ray, hit);
        ASSERT_GT(glm::dot(vertex.surface.geometricNormal, ray.direction), 0) << "after " << bounce << " bounces";
        vertex.position = vertex.surface.position;
        vertex.primitive = hit.primitive;
        const float u = numbers.next<float>();
        const auto sample = sampleDiffuse(-vertex.surface.geometricNormal, glm::vec2(u, numbers.next<float>()));
        // A direction within rounding of the tangent plane is on neither side.
        if (glm::dot(vertex.surface.geometricNormal, sample.direction) > -1e-6f) continue;
        ray = spawnRay(vertex, sample.direction);
    }
}

TEST(ReferenceIntersection, RaysFromConvexSurfacesDoNotHitThemAgain) {  // H40, H41
    HandScene scene;
    const std::uint32_t shape = scene.addDiffuse(glm::vec3(1));
    scene.addSphere({0, 0, 0}, 1, shape);
    scene.addBox({4, -1, -1}, {6, 1, 1}, shape);
    const SceneView<float> view(scene.scene);
    Numbers numbers(4);
    for (int i = 0; i < 100000; ++i) {
        const glm::vec3 center(i % 2 ? 5 : 0, 0, 0);
        Ray<float> ray = rayFrom(center + 20.0f * numbers.direction<float>(), glm::vec3(1, 0, 0));
        ray.direction = glm::normalize(center + numbers.point(0.9f) - ray.origin);
        const Hit<float> hit = closestHit(view, ray);
        if (!hit.found()) continue;
        Vertex<float> vertex;
        vertex.surface = surfaceAt(view, ray, hit);
        vertex.position = vertex.surface.position;
        vertex.primitive = hit.primitive;
        const float u = numbers.next<float>();
        const auto out = sampleDiffuse(vertex.surface.geometricNormal, glm::vec2(u, numbers.next<float>()));
        if (glm::dot(vertex.surface.geometricNormal, out.direction) < 1e-5f) continue;
        ASSERT_NE(closestHit(view, spawnRay(vertex, out.direction)).primitive, hit.primitive);
        ASSERT_EQ(closestHit(view, spawnRay(vertex, -out.direction)).primitive, hit.primitive) << "inwards";
    }
}

TEST(ReferenceIntersection, NormalsPointOutwardsUnlessFlipped) {
    for (const bool isFlipped : {false, true}) {
        HandScene scene;
        const std::uint32_t shape = scene.addDiffuse(glm::vec3(1), isFlipped ? shared::kShapeFlipNormal : 0u);
        scene.addSphere({0, 0, -3}, 1, shape);
        scene.addBox({4, -1, -2}, {6, 1, 2}, shape);
        const SceneView<double> view(scene.scene);
        const double sign = isFlipped ? -1 : 1;
        const Ray<double> atSphere = rayFrom(glm::dvec3(0), glm::dvec3(0, 0, -1));
        const Ray<double> atBox = rayFrom(glm::dvec3(0, 0.5, 0.1), glm::dvec3(1, 0, 0));
        EXPECT_EQ(surfaceAt(view, atSphere, closestHit(view, atSphere)).geometricNormal, glm::dvec3(0, 0, sign));
        EXPECT_EQ(surfaceAt(view, atBox, closestHit(view, atBox)).geometricNormal, glm::dvec3(-sign, 0, 0));
    }
}

}  // namespace
}  // namespace parhelion::reference
