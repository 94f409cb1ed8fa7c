// shaders/core/math.glsl against double precision.
#include "reference/core/math.h"

#include <gtest/gtest.h>

#include "support/gpu_fixture.h"
#include "support/parity_report.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::ErrorMeter;
using test::Parity;
using test::Stress;

const char* const kShader = "parity/math.comp";
enum Function : std::uint32_t { kDivideAndMax, kLog, kExp, kSinCos, kSqrt, kAngle };

std::vector<glm::vec4> firstComponents(const std::vector<float>& values) {
    std::vector<glm::vec4> inputs;
    for (const float value : values) inputs.emplace_back(value, 0, 0, 0);
    return inputs;
}

TEST(MathParity, SafeDivideIsZeroOverZeroAndQuotientElsewhere) {
    std::vector<glm::vec4> inputs{{1, 0, 0, 0}, {0, 0, 0, 0}, {-3, -0.0f, 0, 0}, {1, INFINITY, 0, 0}, {0, 5, 0, 0}};
    Stress stress(3);
    for (int i = 0; i < 1000; ++i)
        inputs.emplace_back(stress.magnitude(1e-15f, 1e15f), -stress.magnitude(1e-15f, 1e15f), stress.between(-1, 1),
                            0);
    const auto outputs = test::probe(kShader, kDivideAndMax, inputs);
    Parity divide("core/math", "safeDivide", 5);  // Vulkan: division within 2.5 ulp
    Parity largest("core/math", "maxComponent", 0);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::dvec3 v(inputs[i]);
        EXPECT_TRUE(divide.near(outputs[i].x, reference::safeDivide(v.x, v.y))) << v.x << " / " << v.y;
        EXPECT_TRUE(largest.near(outputs[i].y, reference::maxComponent(v))) << i;
    }
}

std::vector<float> logarithmInputs() {
    std::vector<float> values{1.0f, 0x1.fffffep-1f, 0x1.000002p0f, 0x1p-126f, 0x1p-48f, 0x1.fffffep127f};
    for (int e = -24; e < -1; ++e) values.insert(values.end(), {1 - std::exp2(float(e)), 1 + std::exp2(float(e + 1))});
    Stress stress(4);
    for (int i = 0; i < 20'000; ++i) values.push_back(stress.magnitude(0x1p-126f, 0x1p127f));
    for (int i = 0; i < 20'000; ++i) values.push_back(stress.between(0.5f, 2.0f));
    return values;
}

// H31, H32: the logarithm next to 1, where short flights come from.
TEST(MathParity, LogIsWithinOneUlpAlsoNextToOneH32) {
    constexpr double kAllowed = 2;  // one ulp; half of it is the last addition
    const auto inputs = firstComponents(logarithmInputs());
    const auto outputs = test::probe(kShader, kLog, inputs);
    Parity parity("core/math", "logPositive", kAllowed);
    ErrorMeter driver;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double expected = reference::logPositive(double(inputs[i].x));
        EXPECT_TRUE(parity.near(outputs[i].x, expected)) << "x = " << inputs[i].x;
        driver.add(outputs[i].y, expected);
    }
    // The software driver's own log is what makes the case hard; a hardware one may be good.
    if (test::testDevice().info().software) {
        EXPECT_GT(driver.worst(), 100 * kAllowed);
    }
}

// H30, H31: optical depths up to the float range and beyond.
TEST(MathParity, ExpIsWithinTwoUlpsDownToTheSmallestNumberH30) {
    constexpr double kAllowed = 4;  // two ulps
    std::vector<float> values{0.0f, -0.0f, -0x1p-30f, -0x1p-24f, -1.0f, -86.999f, -87.0f, -1e-38f};
    Stress stress(5);
    for (int i = 0; i < 20'000; ++i) values.push_back(-stress.between(0, 87));
    for (int i = 0; i < 5'000; ++i) values.push_back(-stress.magnitude(1e-30f, 1));
    const auto inputs = firstComponents(values);
    const auto outputs = test::probe(kShader, kExp, inputs);
    Parity parity("core/math", "expNegative", kAllowed);
    ErrorMeter driver;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double expected = reference::expNegative(double(inputs[i].x));
        EXPECT_TRUE(parity.near(outputs[i].x, expected, expected + 0x1p-126)) << "x = " << inputs[i].x;
        driver.add(outputs[i].y, expected, expected + 0x1p-126);
    }
    if (test::testDevice().info().software) {
        EXPECT_GT(driver.worst(), kAllowed);
    }
    for (const glm::vec4& output : test::probe(kShader, kExp, firstComponents({-87.5f, -1e3f, -1e30f, -INFINITY})))
        EXPECT_EQ(output.x, 0.0f);
}

TEST(MathParity, SinAndCosOfTurnsLoseNothingToTheAngle) {
    // Of the larger of the two: the product with pi / 2 (its constant included) 1.5, polynomial and last sum 1.5.
    constexpr double kAllowed = 3;
    std::vector<float> values = test::stressUniforms(20'000);
    for (int eighth = 0; eighth <= 8; ++eighth) values.push_back(0.125f * float(eighth));
    const auto inputs = firstComponents(values);
    const auto outputs = test::probe(kShader, kSinCos, inputs);
    Parity parity("core/math", "sinCosTurn", kAllowed);
    ErrorMeter naive;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::dvec2 expected = reference::sinCosTurn(double(inputs[i].x));
        EXPECT_TRUE(parity.near(outputs[i].x, expected.x, 1)) << "u = " << inputs[i].x;
        EXPECT_TRUE(parity.near(outputs[i].y, expected.y, 1)) << "u = " << inputs[i].x;
        naive.add(std::sin(6.28318530718f * inputs[i].x), expected.x, 1);
    }
    EXPECT_GT(naive.worst(), kAllowed);
}

TEST(MathParity, AnglesKeepTheirDigitsWhereTheDriversDoNot) {
    // Quotient 1 (its operands 2 more where steep, of an angle of at most pi / 8 in at least pi / 8), polynomial 2,
    // three sums with constants 1.5 each.
    constexpr double kAllowed = 9;
    std::vector<glm::vec4> inputs;
    Stress stress(8);
    for (int i = 0; i < 50'000; ++i) {
        const float small = stress.magnitude(1e-20f, 1), sign = i % 2 ? 1 : -1;
        glm::vec2 xy = i % 3 ? glm::vec2(stress.between(-1, 1), stress.between(-1, 1)) : glm::vec2(sign, small);
        if (i % 5 == 0) std::swap(xy.x, xy.y);
        inputs.emplace_back(i % 7 ? xy : glm::vec2(xy.x, -xy.y), 0, 0);
    }
    for (const float x : {-1.0f, -0.0f, 0.0f, 1.0f})
        for (const float y : {-1.0f, -0.0f, 0.0f, 1.0f}) inputs.emplace_back(x, y, 0, 0);
    const auto outputs = test::probe(kShader, kAngle, inputs);
    Parity parity("core/math", "angleOf", kAllowed);
    ErrorMeter driver;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double expected = reference::angleOf(double(inputs[i].y), double(inputs[i].x));
        EXPECT_TRUE(parity.near(outputs[i].x, expected)) << inputs[i].y << " / " << inputs[i].x;
        driver.add(outputs[i].y, expected);
    }
    if (test::testDevice().info().software) {
        EXPECT_GT(driver.worst(), kAllowed);
    }
}

// Also where the driver's root is off by one to either side, which the software driver's never is.
TEST(MathParity, SquareRootIsRoundedToNearest) {
    Stress stress(7);
    std::vector<glm::vec4> inputs{{0, 0, 0, 0}, {1, 1, 0, 0}, {0x1.fffffep-1f, 1, 0, 0}, {0x1.fffffcp1f, 2, 0, 0}};
    for (int i = 0; i < 20'000; ++i) {
        const float x = stress.magnitude(0x1p-60f, 0x1p60f), near = std::sqrt(x);
        inputs.emplace_back(x, std::nextafter(near, i % 2 ? 0.0f : INFINITY), 0, 0);
        inputs.emplace_back(near * near, near, 0, 0);  // next to an exact square
    }
    const auto outputs = test::probe(kShader, kSqrt, inputs);
    Parity parity("core/math", "roundedSqrt", 0);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const float expected = reference::roundedSqrt(inputs[i].x);
        EXPECT_TRUE(parity.near(outputs[i].x, expected)) << inputs[i].x;
        if (inputs[i].y > 0) EXPECT_EQ(outputs[i].y, expected) << inputs[i].x << " from " << inputs[i].y;
    }
}

}  // namespace
}  // namespace parhelion
