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

/// A ray that leaves the half-plane x < 0, next to the fold or not, and has met one of the faces.
struct Meeting {
    glm::vec3 origin, direction;
    float slack, t;
    std::uint32_t met;
    bool facesUp, isNext;
    glm::vec3 inward;

    reference::Ray<double> ray() const {
        reference::Ray<double> ray;
        ray.origin = origin;
        ray.direction = direction;
        ray.start = {{0, facesUp ? 1 : -1, 0}, {0, 0, isNext}, glm::dvec3(inward), double(slack)};
        return ray;
    }
    reference::Hit<double> hit() const {
        reference::Hit<double> hit;
        hit.primitive = met;
        hit.t = t;
        hit.near = true;
        return hit;
    }
    void addTo(std::vector<glm::vec4>& inputs) const {
        inputs.emplace_back(origin, slack);
        inputs.emplace_back(direction, 0);
        inputs.emplace_back(glm::uintBitsToFloat(glm::uvec2(100, met)), t, 0);
        inputs.emplace_back(0, facesUp ? 1 : -1, 0, isNext);
        inputs.emplace_back(inward, 0);
    }
};

std::vector<Meeting> meetings(float scale) {
    std::vector<Meeting> all;
    Stress stress(41);
    for (int i = 0; i < 4'000; ++i)
        all.push_back({scale * glm::vec3(0, 1e-7f, 0.4f), stress.direction(), 2e-7f * scale,
                       i % 3 == 0 ? 0.0f : 1e-7f * scale, stress.word() % 33, i % 2 == 0, i % 4 != 0,
                       scale * glm::vec3(-0.5f, 0, 0.1f)});
    return all;
}

// Faces of all folds, at several scales. Where a decision is within its rounding either is right: one in 50 of these.
TEST(FlatParity, NeighboursLeftAsideAgree) {
    for (const float scale : {1e-4f, 1.0f, 1e4f}) {
        const test::HandScene built = foldedFaces(scale);
        const reference::SceneView<double> view(built.scene);
        const std::vector<Meeting> all = meetings(scale);
        std::vector<glm::vec4> inputs;
        for (const Meeting& meeting : all) meeting.addTo(inputs);
        const auto outputs = test::SceneProbe(built.scene).run(kShader, kAside, inputs, 5, 1);
        Parity parity("geometry/flat", "isFlatPrimitive leavesAside", 0);
        std::size_t different = 0, aside = 0;
        for (std::size_t i = 0; i < outputs.size(); ++i) {
            const auto normal = reference::flatNormal(view, all[i].met);
            EXPECT_TRUE(parity.equal(outputs[i].x != 0, reference::isFlatPrimitive(view, all[i].met))) << i;
            const bool expected = reference::leavesAside(view, all[i].ray(), all[i].hit(), normal);
            different += expected != (outputs[i].y != 0);
            aside += expected;
        }
        EXPECT_LE(different, outputs.size() / 50) << scale;
        EXPECT_GT(aside, outputs.size() / 4) << scale;
        EXPECT_LT(aside, 9 * outputs.size() / 10) << scale;
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
