// shaders/geometry/bvh.glsl and intersection.glsl against double precision, on small scenes.
#include "reference/geometry/intersection.h"

#include <gtest/gtest.h>

#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using shared::kNone;
using test::Parity;
using test::Stress;

const char* const kShader = "parity/intersection.comp";
enum Function : std::uint32_t { kHit, kBounds, kNormals, kShapes };

/// Walls, an opaque sphere, a null sphere and a null box with media, and a mesh with vertex normals.
struct MixedScene : test::HandScene {
    MixedScene() {
        const std::uint32_t wall = addDiffuse({0.5f, 0.6f, 0.7f}),
                            ball = addDiffuse(glm::vec3(0.3f), shared::kShapeFlipNormal);
        const std::uint32_t medium = addHomogeneous(1, glm::vec3(1));
        cloud = addNull(medium);
        const std::uint32_t block = addNull(medium), mesh = addDiffuse(glm::vec3(0.9f));
        addQuad({-3, -2, -3}, {0, 0, 6}, {6, 0, 0}, wall);
        addQuad({-3, -2, -3}, {6, 0, 0}, {0, 5, 0.5f}, wall);
        addSphere({2, 0, -1}, 0.8f, ball);
        addSphere({-2, 0.3f, 0.5f}, 0.9f, cloud);
        addBox({-0.6f, 1.2f, -0.4f}, {0.7f, 2, 0.6f}, block);
        std::vector<glm::vec3> vertices = test::icosphere(2);
        for (glm::vec3& v : vertices) v = v * glm::vec3(0.9f, 0.7f, 0.8f) + glm::vec3(0, -0.6f, 0.2f);
        addTriangles(vertices, mesh);
        for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
            const glm::vec3 n = glm::vec3(scene.triangles[i]) - glm::vec3(0, -0.6f, 0.2f);
            scene.vertexNormals.emplace_back(i % 30 < 3 ? glm::vec3(0) : n, 0);  // H53: some are flat
        }
        for (std::size_t i = 0; i < scene.shapes.size(); ++i) scene.constants.shapes[i] = scene.shapes[i];
    }
    std::uint32_t cloud = 0;
};

struct TestRay {
    glm::vec3 origin, direction;
    float tMin = 0, tMax = INFINITY;
    std::uint32_t last = kNone, inside = kNone, target = kNone;

    reference::Ray<double> inDouble() const {
        reference::Ray<double> ray;
        ray.origin = origin;
        ray.direction = direction;
        ray.tMin = tMin;
        ray.tMax = tMax;
        ray.last = last;
        ray.inside = inside;
        ray.target = target;
        return ray;
    }
};

/// What the shader says about one ray, ready for the reference.
struct DeviceHit {
    reference::Hit<double> hit;
    reference::Surface<double> surface;
    std::uint32_t inside;
    bool ok;
};

std::vector<DeviceHit> hit(const CompiledScene& scene, const std::vector<TestRay>& rays) {
    std::vector<glm::vec4> inputs;
    for (const TestRay& ray : rays) {
        inputs.emplace_back(ray.origin, ray.tMin);
        inputs.emplace_back(ray.direction, ray.tMax);
        inputs.push_back(glm::uintBitsToFloat(glm::uvec4(ray.last, ray.inside, ray.target, 0)));
    }
    const auto rows = test::SceneProbe(scene).run(kShader, kHit, inputs, 3, 5);
    std::vector<DeviceHit> hits;
    for (std::size_t i = 0; i < rows.size(); i += 5) {
        DeviceHit h{};
        h.hit.t = rows[i].x;
        h.hit.primitive = glm::floatBitsToUint(rows[i].y);
        h.hit.barycentric = {rows[i].z, rows[i].w};
        h.hit.shape = glm::floatBitsToUint(rows[i + 1].w);
        h.hit.exits = rows[i + 3].w != 0;
        h.surface.position = glm::vec3(rows[i + 1]);
        h.surface.geometricNormal = glm::vec3(rows[i + 2]);
        h.surface.shadingNormal = glm::vec3(rows[i + 3]);
        h.inside = glm::floatBitsToUint(rows[i + 2].w);
        h.ok = rows[i + 4].w != 0;
        hits.push_back(h);
    }
    return hits;
}

class IntersectionParity : public testing::Test {
protected:
    std::vector<TestRay> randomRays() const {
        std::vector<TestRay> rays;
        Stress stress(35);
        for (const glm::vec3& direction : test::stressDirections(20'000)) rays.push_back({stress.point(2), direction});
        for (int i = 0; i < 5'000; ++i) {  // H40: from within the medium, and from its boundary
            const glm::vec3 center(built_.scene.constants.spheres[1].center);
            rays.push_back({center + stress.direction() * (i % 2 == 0 ? 0.9f : 0.5f), stress.direction()});
            rays.back().inside = built_.cloud;
            if (i % 4 == 0) rays.back().last = built_.scene.constants.quadCount + 1;
        }
        std::erase_if(rays, [](const TestRay& ray) {  // the other rays start outside of the media
            const glm::vec3 toCloud = ray.origin - glm::vec3(-2, 0.3f, 0.5f);
            const glm::vec3 toBlock =
                glm::abs(ray.origin - glm::vec3(0.05f, 1.6f, 0.1f)) - glm::vec3(0.65f, 0.4f, 0.5f);
            const bool isInBlock = std::max({toBlock.x, toBlock.y, toBlock.z}) < 1e-3f;
            return isInBlock || (ray.inside == kNone && glm::length(toCloud) < 0.901f);
        });
        return rays;
    }

    MixedScene built_;
    reference::SceneView<double> view_{built_.scene};
};

// H40: origins on and within boundaries. Rays that pass an edge within rounding may go either way: one in 2000.
TEST_F(IntersectionParity, ClosestHitSurfaceAndCrossingAgreeH40H53) {
    const auto rays = randomRays();
    const auto hits = hit(built_.scene, rays);
    // Distances: 62 roundings of intersectTriangle, over the cosine at which a surface may be met.
    Parity closest("geometry/intersection", "closestHit hitConvex", 62),
        cross("geometry/intersection", "crossBoundary", 0);
    // Position 2 from the ray, 5 from barycentrics; normals: cross product of differences 5, normalisation 9.
    Parity surface("geometry/surface", "surfaceAt triangleSurface", 14),
        traversal("geometry/bvh", "traverse hitLeaf", 0);
    std::size_t different = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        reference::Ray<double> ray = rays[i].inDouble();
        const auto expected = reference::closestHit(view_, ray);
        EXPECT_TRUE(traversal.equal(hits[i].ok, true)) << i;
        if (hits[i].hit.primitive != expected.primitive) {
            ++different;
            continue;
        }
        if (!expected.found()) continue;
        const auto theirs = reference::surfaceAt(view_, ray, hits[i].hit);
        const double facing = std::abs(glm::dot(theirs.geometricNormal, ray.direction));
        EXPECT_TRUE(closest.near(hits[i].hit.t, expected.t, 4 / (facing * facing)))
            << i << ", primitive " << expected.primitive;
        EXPECT_TRUE(surface.near(hits[i].surface.position, theirs.position, 4))
            << i << ", primitive " << expected.primitive;
        const double size =
            expected.primitive >= view_.firstTriangle ? 20 : 4;  // reach over a triangle's edge, or radius
        EXPECT_TRUE(surface.near(hits[i].surface.geometricNormal, theirs.geometricNormal, size))
            << i << ", primitive " << expected.primitive;
        EXPECT_TRUE(surface.near(hits[i].surface.shadingNormal, theirs.shadingNormal, size))
            << i << ", primitive " << expected.primitive;
        EXPECT_TRUE(cross.equal(hits[i].hit.exits, expected.exits)) << i;
        if (!expected.isNull) continue;
        reference::crossBoundary(view_, expected, ray);
        EXPECT_TRUE(cross.equal(hits[i].inside, ray.inside)) << i;
    }
    EXPECT_LE(different, rays.size() / 2'000);
}

// H47: from within a closed mesh, through the whole hierarchy, at points of its edges.
TEST_F(IntersectionParity, NoRayLeavesAMeshH47) {
    std::vector<TestRay> rays;
    Stress stress(36);
    const auto& triangles = built_.scene.triangles;
    for (int i = 0; i < 50'000; ++i) {
        const std::size_t first = 3 * (stress.word() % (triangles.size() / 3));
        const glm::vec3 edge =
            glm::mix(glm::vec3(triangles[first]), glm::vec3(triangles[first + 1]), stress.between(0, 1));
        const glm::vec3 origin = glm::vec3(0, -0.6f, 0.2f) + stress.point(0.3f);
        rays.push_back({origin, glm::normalize(edge - origin)});
    }
    test::HandScene only;
    std::vector<glm::vec3> vertices(triangles.begin(), triangles.end());
    only.addTriangles(vertices, only.addDiffuse(glm::vec3(1)));
    only.scene.constants.shapes[0] = only.scene.shapes[0];
    Parity parity("geometry/bvh", "traverse", 0);
    for (const DeviceHit& h : hit(only.scene, rays)) EXPECT_TRUE(parity.equal(h.hit.primitive == kNone, false));
}

// H46: of two coincident quads the first one, of two coincident triangles the same one as the reference.
TEST_F(IntersectionParity, LowestOfCoincidentSurfacesWinsH46) {
    test::HandScene twins;
    const std::uint32_t shape = twins.addDiffuse(glm::vec3(0.5f)), other = twins.addDiffuse(glm::vec3(0.9f));
    for (const std::uint32_t s : {shape, other}) twins.addQuad({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, s);
    const std::vector<glm::vec3> vertices{{-1, -1, -4}, {1, -1, -4}, {0, 1, -4}, {-1, -1, -4}, {1, -1, -4}, {0, 1, -4}};
    twins.addTriangles(vertices, shape);
    for (std::size_t i = 0; i < 2; ++i) twins.scene.constants.shapes[i] = twins.scene.shapes[i];
    std::vector<TestRay> rays;
    Stress stress(37);
    for (int i = 0; i < 2'000; ++i) {
        const glm::vec3 target(stress.between(-0.3f, 0.3f), stress.between(-0.8f, 0), -4);
        rays.push_back({{0, 0, i % 2 == 0 ? 0.0f : -3.0f}, {}});
        rays.back().direction = glm::normalize(target - rays.back().origin);
    }
    const auto hits = hit(twins.scene, rays);
    Parity parity("geometry/intersection", "closestHit", 0);
    for (std::size_t i = 0; i < rays.size(); ++i)
        EXPECT_TRUE(parity.equal(hits[i].hit.primitive, i % 2 == 0 ? 0 : 2)) << i;
}

// H39: the slab test of the hierarchy may keep boxes that are missed, but loses none that is met.
TEST_F(IntersectionParity, BoundsAreNeverLostH39) {
    std::vector<glm::vec4> inputs;
    Stress stress(38);
    for (const glm::vec3& direction : test::stressDirections(20'000)) {
        const glm::vec3 a = stress.point(1), b = stress.point(1), low = glm::min(a, b), high = glm::max(a, b);
        glm::vec3 origin = stress.point(3);
        if (stress.word() % 4 == 0) origin = low;  // in three faces at once
        inputs.emplace_back(origin, 0);
        inputs.emplace_back(direction, INFINITY);
        inputs.emplace_back(low, 0);
        inputs.emplace_back(high, 0);
    }
    const auto outputs = test::SceneProbe(built_.scene).run(kShader, kBounds, inputs, 4, 1);
    // A difference, a reciprocal (5) and a product.
    Parity parity("geometry/bvh", "boxEntry", 7);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const glm::dvec3 origin(inputs[4 * i]), direction(inputs[4 * i + 1]);
        const auto ray = reference::prepareBoundsRay(origin, direction, 0.25);
        const double expected =
            reference::boxEntry(inputs[4 * i + 2], inputs[4 * i + 3], ray, 0.0, reference::kInfinity<double>);
        if (std::isinf(expected)) {
            kept += !std::isinf(outputs[i].x);
            continue;
        }
        // The shader starts within a box at tMin.
        EXPECT_TRUE(parity.near(outputs[i].x, std::max(expected, 0.0), expected + 1e-5)) << i;
    }
    EXPECT_LE(kept, outputs.size() / 500);
}

// Shapes nested three deep, fewer and more of them than fit into the uniform block.
TEST_F(IntersectionParity, ShapesAndTheirNestingAgree) {
    for (const std::uint32_t count : {4u, 40u}) {
        test::HandScene nested;
        nested.addHomogeneous(1, glm::vec3(1));
        for (std::uint32_t i = 0; i < count; ++i)
            nested.addShape({{0.1f, 0.2f, float(i)},
                             shared::kShapeNull | (i & 6u),
                             i % 2 == 0 ? 0 : kNone,
                             i % 4 == 0 ? kNone : i - 1,
                             7 * i,
                             0});
        for (std::uint32_t i = 0; i < std::min(count, shared::kMaxInlineShapes); ++i)
            nested.scene.constants.shapes[i] = nested.scene.shapes[i];
        std::vector<glm::vec4> inputs;
        for (std::uint32_t a = 0; a < count; ++a)
            for (std::uint32_t b = 0; b < count; ++b) {
                inputs.insert(inputs.end(), 2, glm::vec4(0));
                inputs.push_back(glm::uintBitsToFloat(glm::uvec4(a, b == a ? kNone : b, 0, 0)));
            }
        const auto outputs = test::SceneProbe(nested.scene).run(kShader, kShapes, inputs, 3, 3);
        const reference::SceneView<double> view(nested.scene);
        Parity shapes("core/scene", "shapeAt interiorOf", 0), nesting("geometry/intersection", "surrounds", 0);
        for (std::size_t i = 0; i < outputs.size() / 3; ++i) {
            const glm::uvec4 ids = glm::floatBitsToUint(inputs[3 * i + 2]);
            const shared::Shape& shape = view.shapeAt(ids.x);
            const glm::uvec4 words = glm::floatBitsToUint(outputs[3 * i + 1]);
            EXPECT_TRUE(shapes.near(outputs[3 * i], shape.reflectance)) << ids.x;
            EXPECT_TRUE(shapes.equal(glm::floatBitsToUint(outputs[3 * i].w) & 7u, shape.flags)) << ids.x;
            EXPECT_EQ(words, glm::uvec4(shape.interior, shape.exterior, shape.light, shape.interior)) << ids.x;
            EXPECT_TRUE(shapes.equal(view.interiorOf(ids.x) == nullptr, words.w == kNone)) << ids.x;
            EXPECT_TRUE(nesting.equal(outputs[3 * i + 2].x != 0, reference::surrounds(view, ids.x, ids.y))) << ids.x;
        }
    }
}

TEST_F(IntersectionParity, NormalsOfConvexShapesAgree) {
    std::vector<glm::vec4> inputs;
    Stress stress(39);
    for (int i = 0; i < 5'000; ++i) inputs.emplace_back(stress.point(3), 0);
    const auto outputs = test::SceneProbe(built_.scene).run(kShader, kNormals, inputs, 1, 3);
    // A column's normalisation; a difference more for the sphere.
    Parity box("geometry/surface", "boxNormal boxSurface", 9), sphere("geometry/surface", "sphereSurface", 10 + 9);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::dvec3 p(inputs[i]), local = glm::abs(view_.boxes[0].localFromWorld.point(p));
        glm::dvec3 sorted = local;
        std::sort(&sorted[0], &sorted[0] + 3);
        if (sorted[2] - sorted[1] > 1e-5) {  // not at an edge
            EXPECT_TRUE(box.near(outputs[3 * i], reference::boxNormal(view_.boxes[0], p))) << i;
            EXPECT_TRUE(box.near(outputs[3 * i + 1], reference::boxSurface(view_, view_.boxes[0], p).geometricNormal))
                << i;
        }
        const double distance = glm::length(p - view_.spheres[0].center);
        EXPECT_TRUE(sphere.near(outputs[3 * i + 2],
                                reference::sphereSurface(view_, view_.spheres[0], p).geometricNormal, 1 + 4 / distance))
            << i;
    }
}

}  // namespace
}  // namespace parhelion
