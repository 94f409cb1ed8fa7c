// shaders/sampling/mis.glsl against double precision.
#include "reference/sampling/mis.h"

#include <gtest/gtest.h>

#include "support/gpu_fixture.h"
#include "support/parity_report.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::ErrorMeter;
using test::Parity;
using test::Stress;

constexpr double kAllowed = 11;  // two divisions of 2.5 ulp (Vulkan) 10, a sum 1

// H69: 0/0 and infinities; H70 and H71: densities whose sum overflows or vanishes.
TEST(MisParity, BalanceHeuristicIsAWeightForAnyDensitiesH69H70H71) {
    std::vector<glm::vec4> inputs;
    const std::vector<float> densities{0, 1e-37f, 1e-25f, 1e-10f, 1, 3, 1e10f, 1e25f, 3e38f, INFINITY};
    for (const float a : densities)
        for (const float b : densities) inputs.emplace_back(a, b, 0, 0);
    Stress stress(9);
    for (int i = 0; i < 5000; ++i)
        inputs.emplace_back(stress.magnitude(1e-8f, 1e8f), stress.magnitude(1e-8f, 1e8f), 0, 0);
    const auto outputs = test::probe("parity/mis.comp", 0, inputs);
    Parity parity("sampling/mis", "balanceHeuristic", kAllowed);
    ErrorMeter naive;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const float a = inputs[i].x, b = inputs[i].y;
        const double expected = reference::balanceHeuristic(double(a), double(b));
        EXPECT_TRUE(parity.near(outputs[i].x, expected)) << a << ", " << b;
        naive.add(a / (a + b), expected);
        const bool isOneCertain = (a > 0 || b > 0) && !(std::isinf(a) && std::isinf(b));
        if (isOneCertain) {
            EXPECT_NEAR(outputs[i].x + outputs[i].y, 1.0, 1e-6) << a << ", " << b;
        }
    }
    EXPECT_GT(naive.worst(), kAllowed);
}

TEST(MisParity, EmissionThatLightSamplingNeverFindsCountsInFull) {
    std::vector<glm::vec4> inputs;
    const std::vector<float> densities{0, 1e-37f, 1e-10f, 0.7f, 3, 1e10f, 3e38f, INFINITY};
    for (const float a : densities)
        for (const float b : densities) inputs.emplace_back(a, b, 0, 0);
    const auto outputs = test::probe("parity/mis.comp", 0, inputs);
    Parity parity("sampling/mis", "emissionWeight", kAllowed);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const float a = inputs[i].x, b = inputs[i].y;
        EXPECT_TRUE(parity.near(outputs[i].z, reference::emissionWeight(double(a), double(b)))) << a << ", " << b;
        if (b == 0) EXPECT_EQ(outputs[i].z, 1.0f) << a;
        if (a == 0 && b > 0) EXPECT_EQ(outputs[i].z, 0.0f) << b;
    }
}

}  // namespace
}  // namespace parhelion
