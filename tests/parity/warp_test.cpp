// shaders/sampling/warp.glsl against double precision.
#include "reference/sampling/warp.h"

#include <gtest/gtest.h>

#include "support/gpu_fixture.h"
#include "support/parity_report.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::ErrorMeter;
using test::Parity;

/// u, v, 1 - cos of a cone: from the sun's disc (H62) and narrower to the whole sphere.
std::vector<glm::vec4> warpInputs() {
    std::vector<glm::vec4> inputs;
    for (const float cone : {1e-12f, 1e-8f, 1.08e-5f, 0.01f, 1.0f, 2.0f})
        for (const float u : test::stressUniforms(40))
            for (const float v : {0.0f, 0.125f, 0.3f, 0.5f, 0.7f, 0.75f, 0x1.fffffep-1f})
                inputs.emplace_back(u, v, cone, 0);
    return inputs;
}

class WarpParity : public testing::Test {
protected:
    std::vector<glm::vec4> inputs_ = warpInputs();
    std::vector<glm::vec4> outputs_ = test::probe("parity/warp.comp", 0, inputs_, 1, 4);
};

// H72: u = 0 and the largest u below 1 are among the inputs of all of them.
TEST_F(WarpParity, HemisphereAndSphereAgreeAtBothEndsOfUH72) {
    // Square root (3 ulp in Vulkan through 1 / inversesqrt) 6 with its argument, sine or cosine 3, product 1.
    Parity hemisphere("sampling/warp", "cosineHemisphere", 10), sphere("sampling/warp", "uniformSphere", 10);
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
        const glm::dvec2 u(inputs_[i]);
        EXPECT_TRUE(hemisphere.near(outputs_[4 * i], reference::cosineHemisphere(u))) << u.x << ", " << u.y;
        EXPECT_TRUE(sphere.near(outputs_[4 * i + 1], reference::uniformSphere(u))) << u.x << ", " << u.y;
    }
}

// H62: the sine of a narrow cone from its cosine loses its digits.
TEST_F(WarpParity, ConeKeepsItsDigitsWhenNarrowH62) {
    constexpr double kAllowed = 10;  // as above, relative to the sine of the polar angle
    Parity parity("sampling/warp", "uniformCone", kAllowed);
    ErrorMeter naive;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
        const glm::dvec3 in(inputs_[i]);
        const glm::dvec3 expected = reference::uniformCone(glm::dvec2(in), in.z);
        const double sine = std::hypot(expected.x, expected.y);
        EXPECT_TRUE(parity.near(outputs_[4 * i + 2].x, expected.x, sine)) << in.x << ", " << in.y << ", " << in.z;
        EXPECT_TRUE(parity.near(outputs_[4 * i + 2].y, expected.y, sine)) << in.x << ", " << in.y << ", " << in.z;
        EXPECT_TRUE(parity.near(outputs_[4 * i + 2].z, expected.z, 1)) << in.x << ", " << in.y << ", " << in.z;
        const float cosine = 1.0f - inputs_[i].z * inputs_[i].x;
        naive.add(std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)), sine);
    }
    EXPECT_GT(naive.worst(), kAllowed);
}

TEST_F(WarpParity, TriangleBarycentricsAgreeAndAreNotNegative) {
    Parity parity("sampling/warp", "uniformTriangle", 8);  // square root 6, product or difference 2
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
        const glm::vec3 b(outputs_[4 * i + 3]);
        EXPECT_TRUE(parity.near(b, reference::uniformTriangle(glm::dvec2(inputs_[i])))) << i;
        EXPECT_GE(std::min({b.x, b.y, b.z}), 0.0f) << i;
    }
}

}  // namespace
}  // namespace parhelion
