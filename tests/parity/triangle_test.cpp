// shaders/geometry/triangle.glsl and ray.glsl against double precision.
#include "reference/geometry/triangle.h"

#include <gtest/gtest.h>

#include "reference/geometry/ray.h"
#include "support/gpu_fixture.h"
#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::kRounding;
using test::Parity;
using test::Stress;

const char* const kShader = "parity/triangle.comp";
enum Function : std::uint32_t { kIntersect, kNearer, kFlat, kError };

struct Case {
    glm::vec3 origin, direction, a, b, c;
};

std::vector<glm::vec4> run(const std::vector<Case>& cases) {
    std::vector<glm::vec4> inputs;
    for (const Case& c : cases)
        for (const glm::vec3& v : {c.origin, c.direction, c.a, c.b, c.c}) inputs.emplace_back(v, 0);
    return test::probe(kShader, kIntersect, inputs, 5, 2);
}

/// How much one rounding of the sheared coordinates moves the results, and how far the ray passes from an edge.
struct Conditioning {
    double barycentric, distance;  ///< scales of (b1, b2) and t
    double margin;                 ///< least |edge function| / |determinant|, in the same scale
};

Conditioning conditioning(const reference::TriangleRay<double>& ray, const Case& triangle) {
    double size = 0, depth = 0;
    glm::dvec2 p[3];
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 v = glm::dvec3(i == 0 ? triangle.a : (i == 1 ? triangle.b : triangle.c)) - ray.origin;
        const double z = v[ray.kz];
        p[i] = {v[ray.kx] - ray.shear.x * z, v[ray.ky] - ray.shear.y * z};
        size = std::max({size, std::abs(v[ray.kx]), std::abs(v[ray.ky]), std::abs(z)});
        depth = std::max(depth, std::abs(z * ray.shear.z));
    }
    const double u = p[2].x * p[1].y - p[2].y * p[1].x, v = p[0].x * p[2].y - p[0].y * p[2].x;
    const double w = p[1].x * p[0].y - p[1].y * p[0].x;
    const double scale = size * size / std::abs(u + v + w);
    return {scale, scale * depth, std::min({std::abs(u), std::abs(v), std::abs(w)}) / (size * size)};
}

std::vector<Case> randomCases() {
    std::vector<Case> cases;
    Stress stress(11);
    for (int i = 0; i < 20'000; ++i) {
        const float size = stress.magnitude(0.01f, 10);
        Case c{stress.point(1), stress.direction(), stress.point(size), stress.point(size), stress.point(size)};
        if (i % 2 == 0) c.direction = glm::normalize((c.a + c.b + c.c) / 3.0f + stress.point(0.3f * size) - c.origin);
        cases.push_back(c);
    }
    for (const glm::vec3& d : test::stressDirections())
        cases.push_back({-d, d, {1, 0.1f, -0.2f}, {-0.5f, 1, 0.3f}, {-0.4f, -1.1f, 0.2f}});
    return cases;
}

TEST(TriangleParity, DistanceAndBarycentricsAgreeWithinTheirConditioning) {
    // A sheared coordinate: difference, product, difference, shear (division 5) 8; twice that in an edge function of
    // two products and a difference 3; three of those in the determinant, then the quotient 5.
    constexpr double kAllowed = 3 * (2 * 8 + 3) + 5;
    const auto cases = randomCases();
    const auto outputs = run(cases);
    Parity shear("geometry/triangle", "rayShear", 5), hits("geometry/triangle", "intersectTriangle", kAllowed);
    int compared = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Case& c = cases[i];
        const auto ray = reference::rayShear(glm::dvec3(c.origin), glm::dvec3(c.direction));
        EXPECT_EQ(int(outputs[2 * i + 1].w), ray.kz) << i;
        for (int axis = 0; axis < 3; ++axis) EXPECT_TRUE(shear.near(outputs[2 * i + 1][axis], ray.shear[axis])) << i;
        const auto hit = reference::intersectTriangle(ray, glm::dvec3(c.a), glm::dvec3(c.b), glm::dvec3(c.c));
        const Conditioning by = conditioning(ray, c);
        if (!(by.margin > kAllowed * kRounding)) continue;  // on an edge: either answer is right
        const bool isHit = outputs[2 * i].y >= 0;
        ASSERT_EQ(isHit, hit.has_value()) << i;
        if (!hit) continue;
        ++compared;
        EXPECT_TRUE(hits.near(outputs[2 * i].x, hit->t, by.distance)) << i;
        EXPECT_TRUE(hits.near(outputs[2 * i].y, hit->b1, by.barycentric)) << i;
        EXPECT_TRUE(hits.near(outputs[2 * i].z, hit->b2, by.barycentric)) << i;
    }
    EXPECT_GT(compared, 2'000);
}

// H45: triangles without area are missed by both; slivers give numbers.
TEST(TriangleParity, DegenerateTrianglesAreMissedH45) {
    std::vector<Case> cases;
    Stress stress(12);
    for (int i = 0; i < 2'000; ++i) {
        const glm::vec3 a = stress.point(1), b = stress.point(1);
        const Case base{stress.point(2), stress.direction(), a, b, b};
        cases.push_back(base);
        cases.push_back({base.origin, glm::normalize(a - base.origin), a, a, a});
        cases.push_back({base.origin, base.direction, a, b, b + 1e-20f * a});
        cases.push_back({base.origin, glm::normalize(a - base.origin), a, b, 0.5f * (a + b)});
    }
    const auto outputs = run(cases);
    Parity parity("geometry/triangle", "intersectTriangle", 0);
    int naive = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Case& c = cases[i];
        EXPECT_FALSE(std::isnan(outputs[2 * i].x)) << i;
        const glm::vec3 n = glm::normalize(glm::cross(c.b - c.a, c.c - c.a));
        naive += std::isnan(glm::dot(c.a - c.origin, n) / glm::dot(c.direction, n));  // plane first, inside later
        if (i % 4 == 3) continue;  // a sliver within rounding: hit or missed
        EXPECT_TRUE(parity.equal(outputs[2 * i].y >= 0, 0)) << i;
        const auto ray = reference::rayShear(glm::dvec3(c.origin), glm::dvec3(c.direction));
        EXPECT_FALSE(i % 4 == 0 &&
                     reference::intersectTriangle(ray, glm::dvec3(c.a), glm::dvec3(c.b), glm::dvec3(c.c)));
    }
    EXPECT_GT(naive, 1'000);
}

/// The point of the plane, then on which side of each edge it is, in float: the obvious test, which is not watertight.
bool hitsNaively(const Case& c) {
    const glm::vec3 n = glm::cross(c.b - c.a, c.c - c.a);
    const float t = glm::dot(c.a - c.origin, n) / glm::dot(c.direction, n);
    const glm::vec3 p = c.origin + c.direction * t;
    const auto isLeft = [&](const glm::vec3& from, const glm::vec3& to) {
        return glm::dot(n, glm::cross(to - from, p - from)) >= 0;
    };
    return t > 0 && isLeft(c.a, c.b) && isLeft(c.b, c.c) && isLeft(c.c, c.a);
}

// H47: rays at the edges and vertices of a closed mesh, from inside.
TEST(TriangleParity, NoRaySlipsBetweenTrianglesH47) {
    const std::vector<glm::vec3> mesh = test::icosphere(0);
    std::vector<Case> cases;
    Stress stress(13);
    const std::size_t triangles = mesh.size() / 3;
    for (std::size_t i = 0; i < triangles; ++i)
        for (int edge = 0; edge < 3; ++edge)
            for (int k = 0; k < 100; ++k) {
                const glm::vec3 origin = stress.point(0.4f);
                const float s = k == 0 ? 0.0f : stress.between(0, 1);
                const glm::vec3 point = glm::mix(mesh[3 * i + edge], mesh[3 * i + (edge + 1) % 3], s);
                for (std::size_t j = 0; j < triangles; ++j)
                    cases.push_back(
                        {origin, glm::normalize(point - origin), mesh[3 * j], mesh[3 * j + 1], mesh[3 * j + 2]});
            }
    const auto outputs = run(cases);
    Parity parity("geometry/triangle", "intersectTriangle", 0);
    int naiveLeaks = 0;
    for (std::size_t ray = 0; ray < cases.size(); ray += triangles) {
        bool hit = false, naive = false;
        for (std::size_t j = ray; j < ray + triangles; ++j) {
            hit = hit || outputs[2 * j].x > 0;
            naive = naive || hitsNaively(cases[j]);
        }
        EXPECT_TRUE(parity.equal(hit, 1)) << "ray " << ray / triangles;
        naiveLeaks += !naive;
    }
    EXPECT_GT(naiveLeaks, 0);
}

// H46: of coincident surfaces the lowest id wins in any order, and the exit of a null boundary before all of them.
TEST(TriangleParity, NearerHitDoesNotDependOnOrderH46) {
    std::vector<reference::Hit<double>> hits;
    for (const double t : {0.0, 1.0, 1.0 + 0x1p-23, double(INFINITY)})
        for (const std::uint32_t primitive : {0u, 1u, 7u, shared::kNone})
            for (const bool exits : {false, true}) {
                reference::Hit<double> hit;
                hit.t = t;
                hit.primitive = primitive;
                hit.exits = exits;
                hits.push_back(hit);
            }
    std::vector<glm::vec4> inputs;
    const auto add = [&](const reference::Hit<double>& h) {
        inputs.emplace_back(float(h.t), glm::uintBitsToFloat(h.primitive), h.exits, 0);
    };
    for (const auto& best : hits)
        for (const auto& candidate : hits) {
            add(best);
            add(candidate);
        }
    const auto outputs = test::probe(kShader, kNearer, inputs, 2, 1);
    Parity parity("geometry/ray", "keepNearer", 0);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        reference::Hit<double> best = hits[i / hits.size()];
        const auto& candidate = hits[i % hits.size()];
        // Both exits of one distance: a ray is inside one shape only.
        if (best.exits && candidate.exits && best.t == candidate.t) continue;
        reference::keepNearer(best, candidate);
        EXPECT_TRUE(parity.near(outputs[i].x, best.t)) << i;
        EXPECT_TRUE(parity.equal(glm::floatBitsToUint(outputs[i].y), best.primitive)) << i;
    }
}

// Flat primitives at, before and behind tMin, with and without uncertainty.
TEST(TriangleParity, WhatIsStillAheadAgrees) {
    std::vector<glm::vec4> inputs;
    for (const float tMin : {0.0f, 1.0f})
        for (const std::uint32_t passed : {0u, 4u, 5u})
            for (const float slack : {-1.0f, 0.0f, 0.25f})
                for (const float t : {-0.5f, -0.1f, 0.0f, 0.1f, 1.0f, 2.0f, 9.0f})
                    for (const float error : {0.0f, 0.2f})
                        for (const std::uint32_t primitive : {3u, 4u, 6u, 7u}) {
                            inputs.emplace_back(tMin, glm::uintBitsToFloat(passed), slack, 0);
                            inputs.emplace_back(t, error, glm::uintBitsToFloat(primitive), 0);
                        }
    const auto outputs = test::probe(kShader, kFlat, inputs, 2, 1);
    Parity parity("geometry/ray", "isAhead hitFlat", 0);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const glm::vec4 &a = inputs[2 * i], &b = inputs[2 * i + 1];
        reference::Ray<float> ray;
        ray.tMin = a.x;
        ray.tMax = 8;
        ray.passed = glm::floatBitsToUint(a.y);
        ray.start.slack = a.z;
        ray.last = 6;
        ray.target = 7;
        reference::Hit<float> hit, best;
        best.t = 8;
        hit.t = b.x;
        hit.primitive = glm::floatBitsToUint(b.z);
        EXPECT_TRUE(parity.equal(outputs[i].w != 0, reference::isAhead(ray, hit.t, hit.primitive))) << i;
        reference::hitFlat(ray, hit, b.y, best);
        EXPECT_TRUE(parity.near(outputs[i].x, best.t)) << i;
        EXPECT_TRUE(parity.equal(glm::floatBitsToUint(outputs[i].y), best.primitive)) << i;
        EXPECT_TRUE(parity.equal(outputs[i].z != 0, best.near)) << i;
    }
}

/// A ray that meets a triangle of this size, far from the origin or not, from within it or from afar.
Case meeting(Stress& stress, int i, float size) {
    const float far = i % 2 == 0 ? 0.0f : 100 * size;
    const glm::vec3 shift(far, 0.3f * far, -far);
    Case c{glm::vec3(0), stress.direction(), shift + stress.point(size), shift + stress.point(size),
           shift + stress.point(size)};
    const float s = stress.between(0, 1), t = stress.between(0, 1);
    c.origin = c.a + (c.b - c.a) * s * (1 - t) + (c.c - c.a) * s * t;
    if (i % 4 == 1) c.origin -= 300 * size * c.direction;
    return c;
}

// The bound holds: distances in float, of rays that start on the triangle's plane give or take `slack` or far from it,
// are off by less.
TEST(TriangleParity, DistancesAreWithinTheirErrorBound) {
    std::vector<Case> cases;
    std::vector<glm::vec4> inputs, bounds;
    Stress stress(16);
    for (int i = 0; i < 40'000; ++i) {
        const float size = stress.magnitude(1e-3f, 1e3f);
        const Case c = cases.emplace_back(meeting(stress, i, size));
        const float slack = i % 3 == 0 ? 0.0f : 1e-6f * size;
        inputs.emplace_back(c.origin, slack);
        for (const glm::vec3& v : {c.direction, c.a, c.b, c.c}) inputs.emplace_back(v, 0);
        bounds.emplace_back(size, size * stress.between(0.1f, 1), 3 * size, size * size);
        bounds.emplace_back(0.5f * size * size * stress.between(0.1f, 1), 1.5f, slack, 0);
    }
    const auto outputs = test::probe(kShader, kIntersect, inputs, 5, 2);
    const auto errors = test::probe(kShader, kError, bounds, 2, 1);
    // Ten products and sums on the way, all of one sign.
    Parity parity("geometry/triangle", "distanceError", 12);
    std::size_t hits = 0, loose = 0, far = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const glm::vec4 &b = bounds[2 * i], &rest = bounds[2 * i + 1];
        // The same roundings as float has: the bound counts in them.
        const double expected = reference::distanceError<float>(glm::vec3(b), b.w, rest.x, rest.y, rest.z);
        EXPECT_TRUE(parity.near(errors[i].x, expected, expected)) << i;
        const Case& c = cases[i];
        if (outputs[2 * i].y < 0) continue;
        // Where the ray's line meets the triangle's plane, and how much more it could be within `slack`.
        const glm::dvec3 n = glm::normalize(glm::cross(glm::dvec3(c.b - c.a), glm::dvec3(c.c) - glm::dvec3(c.a)));
        const double facing = glm::dot(n, glm::dvec3(c.direction));
        const double exact = glm::dot(n, glm::dvec3(c.a) - glm::dvec3(c.origin)) / facing;
        ++hits;
        EXPECT_LE(std::abs(outputs[2 * i].x - exact) + rest.z / std::abs(facing), outputs[2 * i].w) << i;
        const double distance = std::max(double(glm::length(c.b - c.a)), std::abs(exact));
        loose += outputs[2 * i].w > 1e-2 * distance;
        far += exact > 200 * glm::length(c.b - c.a);
    }
    EXPECT_GT(far, 1'000u);
    EXPECT_TRUE(hits > 10'000u && loose < hits / 20)
        << loose << " of " << hits << ": a bound that is nearly the triangle's size tells nothing";
}

}  // namespace
}  // namespace parhelion
