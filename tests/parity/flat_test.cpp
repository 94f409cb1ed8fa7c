// shaders/geometry/flat.glsl, and the crossing of boundaries, against double precision.
#include "reference/geometry/flat.h"

#include <gtest/gtest.h>

#include "reference/geometry/intersection.h"
#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using shared::kNone;
using test::Parity;
using test::Stress;

const char* const kShader = "parity/flat.comp";
enum Function : std::uint32_t { kAside, kCross };

/// Quads and triangles about the z axis, folded at all angles against the plane that a ray leaves.
test::HandScene foldedFaces(float scale) {
    test::HandScene built;
    const std::uint32_t shape = built.addDiffuse(glm::vec3(1));
    const auto spoke = [&](int i, float z) {
        const float angle = float(i - 8) * 0.39f;
        return scale * glm::vec3(std::cos(angle), std::sin(angle), z);
    };
    for (int i = 0; i < 16; ++i) built.addQuad(glm::vec3(0), glm::vec3(0, 0, scale), spoke(i, 0), shape);
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 17; ++i) {
        corners.emplace_back(0);
        corners.emplace_back(0, 0, scale);
        corners.push_back(spoke(i, 0.3f));
    }
    built.addTriangles(corners, shape);
    return built;
}

/// A ray that leaves a face from a point on or next to the fold, and has met another one.
struct Meeting {
    std::uint32_t left, met;
    glm::vec2 weights;
    glm::vec3 origin, direction;
    float slack, t;

    reference::Ray<float> ray() const {
        reference::Ray<float> ray;
        ray.origin = origin;
        ray.direction = direction;
        ray.last = left;
        ray.start = {weights, slack};
        return ray;
    }
    reference::Hit<float> hit() const {
        reference::Hit<float> hit;
        hit.primitive = met;
        hit.t = t;
        hit.near = true;
        return hit;
    }
    void addTo(std::vector<glm::vec4>& inputs) const {
        inputs.emplace_back(origin, slack);
        inputs.emplace_back(direction, 0);
        inputs.emplace_back(glm::uintBitsToFloat(glm::uvec2(left, met)), t, 0);
        inputs.emplace_back(weights, 0, 0);
    }
};

std::vector<Meeting> meetings(const reference::SceneView<float>& view, float scale) {
    std::vector<Meeting> all;
    Stress stress(41);
    for (int i = 0; i < 6'000; ++i) {
        Meeting meeting{.left = stress.word() % 33, .met = stress.word() % 33};
        if (meeting.left == meeting.met) continue;
        const float beside[] = {0, 1e-7f, 1e-5f, 0.01f};  // from the fold
        meeting.weights = {0.4f, beside[i % 4]};
        const auto face = reference::faceOf(view, meeting.left);
        const auto& c = face.corners;
        const glm::vec3 normal = reference::planeOf(face).normal;
        meeting.origin = c[0] + meeting.weights.x * (c[1] - c[0]) + meeting.weights.y * (c[2] - c[0]) +
                         normal * (i % 3 == 0 ? 0 : 1e-7f * scale);
        meeting.direction = stress.direction();
        meeting.slack = 2e-7f * scale;
        meeting.t = i % 5 == 0 ? 0 : 1e-7f * scale;
        all.push_back(meeting);
    }
    return all;
}

// Faces of all folds, at several scales. The rule depends on what a float can tell: the twin is in float. Where a
// decision is within its rounding either is right: one in 200 of these.
TEST(FlatParity, NeighboursLeftAsideAgree) {
    for (const float scale : {1e-4f, 1.0f, 1e4f}) {
        const test::HandScene built = foldedFaces(scale);
        const reference::SceneView<float> view(built.scene);
        const std::vector<Meeting> all = meetings(view, scale);
        std::vector<glm::vec4> inputs;
        for (const Meeting& meeting : all) meeting.addTo(inputs);
        const auto outputs = test::SceneProbe(built.scene).run(kShader, kAside, inputs, 4, 1);
        Parity parity("geometry/flat", "isFlatPrimitive leavesAside", 0);
        std::size_t different = 0, aside = 0;
        for (std::size_t i = 0; i < outputs.size(); ++i) {
            EXPECT_TRUE(parity.equal(outputs[i].x != 0, reference::isFlatPrimitive(view, all[i].met))) << i;
            const bool expected = reference::leavesAside(view, all[i].ray(), all[i].hit());
            different += expected != (outputs[i].y != 0);
            aside += expected;
        }
        EXPECT_LE(different, outputs.size() / 200) << scale;
        EXPECT_GT(aside, outputs.size() / 4) << scale;
        EXPECT_LT(aside, 9 * outputs.size() / 10) << scale;
    }
}

// Faces of all shapes down to slivers, against double: within the bound that comes with each distance.
TEST(FlatParity, DistancesAreWithinTheirBounds) {
    Stress stress(43);
    std::vector<glm::vec4> inputs;
    for (int i = 0; i < 4'000; ++i) {
        const glm::vec3 a = 3.0f * stress.direction(), u = stress.direction();
        const float thin = std::exp2(-float(i % 12));
        const glm::vec3 b = a + u, c = a + (i % 2 == 0 ? 0.5f : thin) * u + thin * stress.direction();
        for (const glm::vec3& corner : {a, b, c}) inputs.emplace_back(corner, 0);
        inputs.emplace_back(a + 0.3f * (b - a) + 1e-3f * stress.direction(), 0);
    }
    const test::HandScene built = foldedFaces(1);
    const auto outputs = test::SceneProbe(built.scene).run("parity/plane.comp", 0, inputs, 4, 3);
    Parity parity("geometry/flat", "planeOf planeDistance startDistance", 1);
    for (std::size_t i = 0; i < inputs.size() / 4; ++i) {
        const glm::dvec3 a(inputs[4 * i]), b(inputs[4 * i + 1]), c(inputs[4 * i + 2]), point(inputs[4 * i + 3]);
        const reference::Face<double> face{{a, b, c}, 3};
        const auto plane = reference::planeOf(face);
        // Which corner has the widest angle may be a tie: then either is right, and the spread is the same.
        const bool isCorner = face.hasCorner(glm::dvec3(outputs[3 * i]));
        EXPECT_TRUE(isCorner && glm::distance(glm::dvec3(outputs[3 * i + 1]) *
                                                  glm::sign(glm::dot(glm::dvec3(outputs[3 * i + 1]), plane.normal)),
                                              plane.normal) < 5e-7 * plane.spread)
            << i;
        EXPECT_NEAR(outputs[3 * i].w / plane.spread, 1, 1e-6 * plane.spread) << i;
        EXPECT_TRUE(parity.equal(outputs[3 * i + 1].w, 0.0f)) << i;
        const double exact = reference::planeDistance(plane, face, point).value;
        const glm::vec4 distances = outputs[3 * i + 2];
        EXPECT_LE(std::abs(distances.x - exact), distances.y) << i;
        EXPECT_LE(std::abs(distances.z - exact), distances.w + 1e-16) << i;
    }
}

/// Three shapes, two nested and one beside them, of two triangles each that face both ways.
struct ThreeBoundaries : test::HandScene {
    ThreeBoundaries() {
        const std::uint32_t medium = addHomogeneous(1, glm::vec3(1));
        const std::uint32_t outer = addNull(medium);
        addNull(medium, outer);
        addNull(medium);
        std::vector<glm::vec3> corners;
        for (int i = 0; i < 6; ++i)
            for (const glm::vec3& v : {glm::vec3(0), glm::vec3(i % 2, 1 - i % 2, 0), glm::vec3(1 - i % 2, i % 2, 0)})
                corners.push_back(v);
        addTriangles(corners, outer);
        for (std::uint32_t i = 0; i < 6; ++i) scene.triangles[3 * i].w = glm::uintBitsToFloat(i / 2);
        for (std::size_t i = 0; i < 3; ++i) scene.constants.shapes[i] = scene.shapes[i];
    }
};

struct Crossing {
    std::uint32_t inside, primitive, idle;  ///< idle: as the shader packs it
    float t;

    reference::Ray<double> ray() const {
        reference::Ray<double> ray;
        ray.direction = {0, 0, 1};
        ray.inside = inside;
        ray.tMin = 0.5;
        ray.passed = 3;
        if (idle > 0) ray.idle = {idle / 2 - 1, idle % 2 == 1, 1.0};
        return ray;
    }
    reference::Hit<double> hit() const {
        reference::Hit<double> hit;
        hit.t = t;
        hit.primitive = primitive;
        hit.shape = primitive / 2;
        hit.isNull = true;
        return hit;
    }
};

std::vector<Crossing> crossings() {
    std::vector<Crossing> all;
    for (const std::uint32_t inside : {0u, 1u, 2u, kNone})
        for (std::uint32_t primitive = 0; primitive < 6; ++primitive)
            for (const std::uint32_t idle : {0u, 2u, 3u, 4u, 5u, 6u, 7u})
                for (const float t : {1.0f, 1.00001f, 1.001f}) all.push_back({inside, primitive, idle, t});
    return all;
}

TEST(FlatParity, CrossingsAgreeWhateverCameBefore) {
    const ThreeBoundaries built;
    const reference::SceneView<double> view(built.scene);
    const std::vector<Crossing> all = crossings();
    std::vector<glm::vec4> inputs;
    for (const Crossing& c : all) {
        const std::uint32_t shape = c.primitive / 2;
        inputs.emplace_back(glm::uintBitsToFloat(c.idle), 1.0f, glm::uintBitsToFloat(3u), 0.5f);
        inputs.push_back(glm::uintBitsToFloat(glm::uvec4(shape, built.scene.shapes[shape].exterior, 0, c.primitive)));
        inputs.emplace_back(0, glm::uintBitsToFloat(c.inside), c.t, float(reference::flatNormal(view, c.primitive).z));
        inputs.insert(inputs.end(), 2, glm::vec4(0));
    }
    const auto outputs = test::SceneProbe(built.scene).run(kShader, kCross, inputs, 5, 2);
    Parity parity("geometry/intersection", "crossBoundary passHit", 0);
    for (std::size_t i = 0; i < all.size(); ++i) {
        reference::Ray<double> ray = all[i].ray();
        reference::crossBoundary(view, all[i].hit(), ray);
        const glm::uvec4 words = glm::floatBitsToUint(outputs[2 * i]);
        const std::uint32_t idle = ray.idle.shape == kNone ? 0 : 2 * (ray.idle.shape + 1) + ray.idle.entered;
        EXPECT_TRUE(parity.equal(words.x, ray.inside)) << i;
        EXPECT_TRUE(parity.equal(words.y, idle)) << i;
        EXPECT_TRUE(idle == 0 || parity.near(outputs[2 * i].z, ray.idle.t)) << i;
        EXPECT_TRUE(parity.equal(words.w, ray.passed)) << i;
        EXPECT_TRUE(parity.near(outputs[2 * i + 1].x, ray.tMin)) << i;
    }
}

}  // namespace
}  // namespace parhelion
