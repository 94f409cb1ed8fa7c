// shaders/volume/phase_function.glsl against double precision.
#include "reference/volume/phase_function.h"

#include <gtest/gtest.h>

#include "support/gpu_fixture.h"
#include "support/parity_report.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::ErrorMeter;
using test::Parity;
using test::Stress;

/// Asymmetries of H1 to H3, both signs.
std::vector<float> asymmetries() {
    std::vector<float> values{0, -0.0f};
    for (const float g :
         {1e-8f, 1e-7f, 1e-6f, 1e-4f, 1e-3f, 0.1f, 0.5f, 0.85f, 0.9f, 0.99f, 0.999f, 0.99999f, 0.999999f})
        values.insert(values.end(), {g, -g});
    return values;
}

struct Deflection {
    float g, u;
    glm::vec3 wo, wi;
};

/// u at both ends (H4) and between; pairs of directions at and next to mu = +-1 (H5) and anywhere.
std::vector<Deflection> deflections() {
    std::vector<Deflection> all;
    Stress stress(18);
    for (const float g : asymmetries())
        for (const float u : test::stressUniforms(150)) {
            const glm::vec3 wo = stress.direction();
            glm::vec3 wi = stress.direction();
            if (stress.word() % 2 == 0)
                wi = glm::normalize((stress.word() % 2 == 0 ? -wo : wo) + stress.magnitude(1e-7f, 0.1f) * wi);
            all.push_back({g, u, wo, wi});
        }
    return all;
}

class PhaseFunctionParity : public testing::Test {
protected:
    PhaseFunctionParity() {
        std::vector<glm::vec4> inputs;
        for (const Deflection& d : cases_) {
            inputs.emplace_back(d.g, d.u, 0, 0);
            inputs.emplace_back(d.wo, 0);
            inputs.emplace_back(d.wi, 0);
        }
        outputs_ = test::probe("parity/phase_function.comp", 0, inputs, 3, 2);
    }

    std::vector<Deflection> cases_ = deflections();
    std::vector<glm::vec4> outputs_;
};

/// The textbook inversion in float.
float naiveCosine(float g, float u) {
    const float s = (1 - g * g) / (1 - g + 2 * g * u);
    return (1 + g * g - s * s) / (2 * g);
}

/// The textbook density in float.
float naiveDensity(float g, float mu) {
    const float square = 1 + g * g - 2 * g * mu;
    return (1 - g * g) / (4 * 3.14159265f * square * std::sqrt(square));
}

// H1: g next to +-1; H2: g = 0; H3: tiny g; H4: u at its ends. The textbook inversion fails for each of them.
TEST_F(PhaseFunctionParity, SampleAgreesForEveryAsymmetryAndUH1H2H3H4) {
    // 1 - mu and 1 + mu are products of about ten factors, each of at most two roundings, and a squared quotient
    // (2.5 ulp in Vulkan, twice) 10; numerics allows 1e-6, which is 17.
    constexpr double kAllowed = 17;
    Parity parity("volume/phase_function", "sampleHenyeyGreenstein", kAllowed);
    ErrorMeter towardsOne, zero, tiny;
    for (std::size_t i = 0; i < cases_.size(); ++i) {
        const auto [g, u] = std::pair(cases_[i].g, cases_[i].u);
        const auto expected = reference::sampleHenyeyGreenstein(double(g), double(u));
        const glm::vec4 sample = outputs_[2 * i];
        EXPECT_TRUE(parity.near(sample.x, expected.mu, 1)) << "g = " << g << ", u = " << u;
        EXPECT_TRUE(parity.near(sample.y, expected.sinTheta)) << "g = " << g << ", u = " << u;
        EXPECT_TRUE(parity.near(sample.z, expected.pdf)) << "g = " << g << ", u = " << u;
        EXPECT_NEAR(double(sample.x) * sample.x + double(sample.y) * sample.y, 1.0, 1.1e-6) << i;  // H4: unit
        const float size = std::abs(g), cosine = naiveCosine(g, u);
        const double sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
        if (g == 0)
            zero.add(cosine, expected.mu, 1);
        else if (size <= 1e-3f)
            tiny.add(cosine, expected.mu, 1);
        else if (size >= 0.99f)
            towardsOne.add(sine, expected.sinTheta);
    }
    EXPECT_GT(towardsOne.worst(), kAllowed);
    EXPECT_GT(zero.worst(), kAllowed);
    EXPECT_GT(tiny.worst(), kAllowed);
}

// H5: the density at mu next to +-1, where the peak of a forward lobe is; H9: travel keeps its direction for g > 0.
TEST_F(PhaseFunctionParity, DensityKeepsItsDigitsAtThePeakH5H9) {
    // D^2 takes a difference (1 each, squared) and a dot product 2 + 5, its 3/2th power 1.5 times that and a root and
    // two products 8; the quotient and factors 10. |g| is a float, so that 1 - |g| is exact.
    constexpr double kAllowed = 1.5 * 8 + 8 + 10;
    Parity parity("volume/phase_function", "evalHenyeyGreenstein", kAllowed);
    ErrorMeter naive;
    for (std::size_t i = 0; i < cases_.size(); ++i) {
        const Deflection& d = cases_[i];
        const double expected = reference::evalHenyeyGreenstein(double(d.g), glm::dvec3(d.wo), glm::dvec3(d.wi));
        EXPECT_TRUE(parity.near(outputs_[2 * i + 1].x, expected)) << "g = " << d.g << ", case " << i;
        naive.add(naiveDensity(d.g, glm::dot(-d.wo, d.wi)), expected);
    }
    EXPECT_GT(naive.worst(), kAllowed);
    const std::vector<glm::vec4> forward{{0.9f, 0, 0, 0}, {0, 0, -1, 0}, {0, 0, 1, 0},    // goes on
                                         {0.9f, 0, 0, 0}, {0, 0, -1, 0}, {0, 0, -1, 0}};  // turns back
    const auto values = test::probe("parity/phase_function.comp", 0, forward, 3, 2);
    EXPECT_GT(values[1].x, 1000 * values[3].x);  // (1.9 / 0.1)^3
}

// H6: the density that the sampler returns is that of its direction; it inverts a distribution function, so that the
// density then integrates to 1.
TEST_F(PhaseFunctionParity, DensityOfSampleIsTheDensityOfItsDirectionH6) {
    // Both sides above, and the direction's own rounding, which the peak magnifies by a / (1 - a) at most.
    Parity parity("volume/phase_function", "evalHenyeyGreenstein sampleHenyeyGreenstein", 17 + 30);
    std::vector<glm::vec4> inputs;
    for (std::size_t i = 0; i < cases_.size(); ++i) {
        const glm::vec4 sample = outputs_[2 * i];
        inputs.emplace_back(cases_[i].g, cases_[i].u, 0, 0);
        inputs.emplace_back(0, 0, -1, 0);
        inputs.emplace_back(sample.y, 0, sample.x, 0);
    }
    const auto outputs = test::probe("parity/phase_function.comp", 0, inputs, 3, 2);
    for (std::size_t i = 0; i < cases_.size(); ++i) {
        const double a = std::abs(double(cases_[i].g)), magnified = 1 + 3 * a / (1 - a);
        EXPECT_TRUE(parity.near(outputs[2 * i + 1].x, outputs[2 * i].z, magnified * outputs[2 * i].z))
            << "g = " << cases_[i].g << ", u = " << cases_[i].u;
    }
}

}  // namespace
}  // namespace parhelion
