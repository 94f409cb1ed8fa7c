// shaders/volume/tracking.glsl against double precision: single decisions and steps.
#include "reference/volume/tracking.h"

#include <gtest/gtest.h>

#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::Parity;
using test::Stress;

const char* const kShader = "parity/tracking.comp";
enum Function : std::uint32_t { kFlight, kShadow, kAnalytic, kStep };
constexpr float kArrived = 1, kCollided = 2, kRouletted = 3;  // of the shader

/// Real shares with zero and whole channels among them (H36).
glm::vec3 share(Stress& stress) {
    glm::vec3 q = stress.point(1) * 0.5f + 0.5f;
    for (int c = 0; c < 3; ++c)
        if (const std::uint32_t pick = stress.word() % 8; pick < 2) q[c] = float(pick);
    return q;
}

std::vector<glm::vec4> runInMedium(const test::HandScene& built, Function function,
                                   const std::vector<glm::vec4>& inputs) {
    return test::SceneProbe(built.scene).run(kShader, function, inputs, 3, 3);
}

test::HandScene homogeneousScene() {
    test::HandScene built;
    built.addHomogeneous(2.5f, glm::vec3(1), 0, {1, 0.5f, 0.1f});
    return built;
}

// H19: u next to 1 against a share of 1; H36: channels that cannot collide.
TEST(TrackingParity, FlightDecisionsAreTheSameH19H36) {
    const test::HandScene built = homogeneousScene();
    std::vector<glm::vec4> inputs;
    Stress stress(24);
    const auto uniforms = test::stressUniforms();
    for (int i = 0; i < 20'000; ++i) {
        inputs.emplace_back(0, 1, 1, i % 3);
        inputs.emplace_back(1);
        inputs.emplace_back(share(stress), uniforms[stress.word() % uniforms.size()]);
    }
    const auto outputs = runInMedium(built, kFlight, inputs);
    const reference::SceneView<double> view(built.scene);
    reference::Medium<double> medium = view.media[0];
    // A difference and a quotient (5) for the channel and for the hero.
    Parity decision("volume/tracking", "decideFlight", 12), purpose("volume/tracking", "segmentPurpose", 0);
    for (std::size_t i = 0; i < inputs.size(); i += 3) {
        const int hero = int(inputs[i].w);
        medium.sigmaRatio = glm::dvec3(inputs[i + 2]);
        reference::Throughput<double> throughput;
        const bool isReal =
            reference::decideFlight(medium, glm::dvec3(1), 1.0, double(inputs[i + 2].w), hero, throughput);
        EXPECT_TRUE(decision.equal(outputs[i].w == kCollided, isReal)) << i;
        EXPECT_TRUE(decision.near(glm::dvec3(outputs[i + 1]) / double(outputs[i + 1][hero]), throughput.r,
                                  std::max(1.0, reference::maxComponent(throughput.r))))
            << i;
        EXPECT_TRUE(purpose.equal(glm::floatBitsToUint(outputs[i + 1].w), shared::kDrawFlight));
    }
}

TEST(TrackingParity, ShadowDecisionsAreTheSame) {
    const test::HandScene built = homogeneousScene();
    std::vector<glm::vec4> inputs;
    Stress stress(25);
    for (int i = 0; i < 20'000; ++i) {
        inputs.emplace_back(0, 1, 1, i % 5 == 0 ? 0.0f : stress.between(0, 1));  // 0: no roulette; threshold
        inputs.emplace_back(i % 4 == 0 ? glm::vec3(1) : share(stress), 0);       // weight so far
        inputs.emplace_back(share(stress), stress.between(0, 1));
    }
    const auto outputs = runInMedium(built, kShadow, inputs);
    // Product 1 and difference 1; the threshold's quotient 5 and product 1.
    Parity parity("volume/tracking", "decideShadow", 8);
    for (std::size_t i = 0; i < inputs.size(); i += 3) {
        glm::dvec3 weight(inputs[i + 1]);
        const double u = inputs[i + 2].w, threshold = inputs[i].w;
        const double largest = reference::maxComponent(weight * (1.0 - glm::dvec3(inputs[i + 2])));
        const double gap = std::min(std::abs(largest - threshold), std::abs(u * threshold - largest));
        if (gap < 1e-6 && largest > 0) continue;  // decided within rounding
        const bool isAlive = reference::decideShadow(glm::dvec3(inputs[i + 2]), u, threshold, weight);
        EXPECT_TRUE(parity.equal(outputs[i].w == kRouletted, !isAlive)) << i;
        EXPECT_TRUE(parity.near(outputs[i], isAlive ? weight : glm::dvec3(0))) << i;
    }
}

// H13: thin media; H30: optical depths beyond what exp can give.
TEST(TrackingParity, AnalyticTransmittanceAgreesThinAndThickH13H30) {
    std::vector<glm::vec4> inputs;
    Stress stress(26);
    for (int i = 0; i < 5'000; ++i) {
        const float t = stress.between(0, 3);
        inputs.emplace_back(t, t + stress.magnitude(1e-8f, 1e3f), 0, 0);
        inputs.emplace_back(share(stress), 0);
        inputs.emplace_back(0);
    }
    const test::HandScene built = homogeneousScene();
    const shared::Medium& medium = built.scene.constants.media[0];
    const auto outputs = runInMedium(built, kAnalytic, inputs);
    // Exponent: three roundings of the depth; exp 4 and the weight's product.
    Parity parity("volume/tracking", "stepAnalytically", 5);
    for (std::size_t i = 0; i < inputs.size(); i += 3) {
        EXPECT_EQ(outputs[i].w, kArrived);
        for (int c = 0; c < 3; ++c) {
            const double depth = double(medium.sigmaMax) * medium.sigmaRatio[c] * (double(inputs[i].y) - inputs[i].x);
            const double expected = inputs[i + 1][c] * reference::expNegative(-depth);
            EXPECT_TRUE(parity.near(outputs[i][c], expected, expected * (1 + depth))) << "depth " << depth;
        }
    }
}

/// Majorants between 1 and 4 in 5 x 3 x 2 cells of [0, 5] x [0, 3] x [0, 2]; a density of 1.
test::HandScene cellScene() {
    test::HandScene built;
    const glm::uvec3 resolution(40, 24, 16);
    const std::vector<float> voxels(resolution.x * resolution.y * resolution.z, 1.0f);
    built.addGrid(0.7f, glm::vec3(1), resolution, voxels, {0, 0, 0}, {5, 3, 2});
    for (std::size_t i = 0; i < built.scene.majorants.size(); ++i) built.scene.majorants[i] = 1 + float(i * 7 % 4);
    return built;
}

TEST(TrackingParity, StepsReachTheSameCollisionOrTheEnd) {
    const test::HandScene built = cellScene();
    const reference::SceneView<double> view(built.scene);
    std::vector<glm::vec4> inputs;
    Stress stress(27);
    for (const glm::vec3& direction : test::stressDirections(5'000)) {
        inputs.emplace_back(0, stress.between(0.1f, 6), stress.magnitude(0.01f, 20), 0);
        inputs.emplace_back(stress.between(0, 5), stress.between(0, 3), stress.between(0, 2), 0);
        inputs.emplace_back(direction, 0);
    }
    const auto outputs = runInMedium(built, kStep, inputs);
    // Up to ten cells, each of which moves the optical depth by its planes' error, 19 + 3 roundings of lengths up to 6,
    // times a majorant of at most four times the collision's own.
    Parity parity("volume/tracking", "stepSegment", 10 * 22 * 4);
    const glm::uvec4 words = reference::draw({1, 2}, 0, shared::kDrawFlight);
    const double renewed = reference::exponential<double>(words.z, words.w >> 8);
    int collided = 0;
    for (std::size_t i = 0; i < inputs.size(); i += 3) {
        reference::CellWalk<double> walk =
            reference::gridRay(view.media[0], glm::dvec3(inputs[i + 1]), glm::dvec3(inputs[i + 2]));
        reference::startCell(view.media[0], 0.0, walk);
        reference::Residual<double> residual{double(inputs[i].z)};
        reference::Counters counters{};
        const double end = inputs[i].y;
        const bool collides = reference::nextCollision(view.media[0], walk, end, residual, counters);
        const glm::vec4 got = outputs[i + 2];
        EXPECT_TRUE(parity.near(got.x, walk.t, 6)) << i;
        if (std::abs(walk.t - end) < 1e-3 && (got.z != 0) != collides) continue;  // at the end within rounding
        ASSERT_EQ(got.z != 0, collides) << i;
        collided += collides;
        if (collides) {
            EXPECT_NEAR(got.y, renewed, 4e-6 * renewed) << i;
        } else {
            EXPECT_TRUE(parity.near(got.y, residual.depth, 6 * 0.7)) << i;
            EXPECT_EQ(outputs[i].w, kArrived) << i;
        }
    }
    EXPECT_GT(collided, 1'000);
}

}  // namespace
}  // namespace parhelion
