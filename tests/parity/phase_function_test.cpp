// shaders/volume/phase_function.glsl against double precision.
#include "reference/volume/phase_function.h"

#include <gtest/gtest.h>

#include "support/parity_report.h"
#include "support/phase_cases.h"
#include "support/scene_probe.h"
#include "support/stress.h"
#include "support/words.h"

namespace parhelion {
namespace {

using test::ErrorMeter;
using test::Parity;
using test::PhaseCase;
using test::Stress;

/// Asymmetries of H1 to H3, both signs.
std::vector<float> asymmetries() {
    std::vector<float> values{0, -0.0f};
    for (const float g :
         {1e-8f, 1e-7f, 1e-6f, 1e-4f, 1e-3f, 0.1f, 0.5f, 0.85f, 0.9f, 0.99f, 0.999f, 0.99999f, 0.999999f})
        values.insert(values.end(), {g, -g});
    return values;
}

const char* const kShader = "parity/phase_function.comp";
enum Function : std::uint32_t { kHenyeyGreenstein, kRayleigh, kTable, kAny };

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

/// Rows of the shader's inputs.
void addTo(std::vector<glm::vec4>& inputs, float u, float gOrMedium, const glm::vec3& wo, const glm::vec3& wi,
           std::uint32_t interval = 0, std::uint32_t word = 0) {
    inputs.emplace_back(u, gOrMedium, float(interval), float(word >> 16));
    inputs.emplace_back(wo, float(word & 0xffff));
    inputs.emplace_back(wi, 0);
}

std::vector<glm::vec4> run(Function function, const std::vector<glm::vec4>& inputs, const CompiledScene& scene = {}) {
    return test::SceneProbe(scene).run(kShader, function, inputs, 3, 2);
}

class PhaseFunctionParity : public testing::Test {
protected:
    PhaseFunctionParity() {
        std::vector<glm::vec4> inputs;
        for (const Deflection& d : cases_) addTo(inputs, d.u, d.g, d.wo, d.wi);
        outputs_ = run(kHenyeyGreenstein, inputs);
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
    std::vector<glm::vec4> forward;
    for (const float goesOn : {1.0f, -1.0f}) addTo(forward, 0, 0.9f, {0, 0, -1}, {0, 0, goesOn});
    const auto values = run(kHenyeyGreenstein, forward);
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
        addTo(inputs, cases_[i].u, cases_[i].g, {0, 0, -1}, {sample.y, 0, sample.x});
    }
    const auto outputs = run(kHenyeyGreenstein, inputs);
    for (std::size_t i = 0; i < cases_.size(); ++i) {
        const double a = std::abs(double(cases_[i].g)), magnified = 1 + 3 * a / (1 - a);
        EXPECT_TRUE(parity.near(outputs[2 * i + 1].x, outputs[2 * i].z, magnified * outputs[2 * i].z))
            << "g = " << cases_[i].g << ", u = " << cases_[i].u;
    }
}

/// A pair of directions at and next to mu = +-1, or anywhere.
std::pair<glm::vec3, glm::vec3> directionPair(Stress& stress) {
    const glm::vec3 wo = stress.direction(), wi = stress.direction();
    const std::uint32_t kind = stress.word() % 4;
    if (kind < 2) return {wo, wi};
    return {wo, glm::normalize((kind == 2 ? wo : -wo) + stress.magnitude(1e-7f, 0.1f) * wi)};
}

// H4 and H5 for Rayleigh's function; Cardano's formula as the textbooks have it loses the poles.
TEST(RayleighParity, SampleAndDensityAgreeH4H5) {
    // 1 - |mu|: the root before the last step is off by a few roundings, of which a quarter stays; that step has six
    // and a quotient (5). Half of it in sinTheta, and a root (6).
    constexpr double kAllowed = 15;
    Parity sample("volume/phase_function", "sampleRayleigh", kAllowed),
        value("volume/phase_function", "evalRayleigh", 9);
    ErrorMeter naive;
    std::vector<glm::vec4> inputs;
    Stress stress(19);
    for (const float u : test::stressUniforms(4'000)) {
        const auto [wo, wi] = directionPair(stress);
        addTo(inputs, u, 0, wo, wi);
    }
    const auto outputs = run(kRayleigh, inputs);
    for (std::size_t i = 0; i < outputs.size() / 2; ++i) {
        const float u = inputs[3 * i].x;
        const auto expected = reference::sampleRayleigh(double(u));
        EXPECT_TRUE(sample.near(outputs[2 * i].x, expected.mu, 1)) << "u = " << u;
        EXPECT_TRUE(sample.near(outputs[2 * i].y, expected.sinTheta)) << "u = " << u;
        EXPECT_TRUE(sample.near(outputs[2 * i].z, expected.pdf)) << "u = " << u;
        EXPECT_TRUE(value.near(outputs[2 * i + 1].x,
                               reference::evalRayleigh(glm::dvec3(inputs[3 * i + 1]), glm::dvec3(inputs[3 * i + 2]))));
        const float z = 4 * u - 2, y = std::cbrt(z + std::sqrt(z * z + 1)), mu = y - 1 / y;
        naive.add(std::sqrt(std::max(0.0f, 1 - mu * mu)), expected.sinTheta);
    }
    EXPECT_GT(naive.worst(), 100 * kAllowed);
}

/// Tables of one interval, with empty ones, with single peaks, nearly constant, and long.
std::vector<PhaseCase> tables() {
    std::vector<PhaseCase> found;
    for (PhaseCase& phase : test::newPhaseCases())
        if (phase.record().phase == shared::kPhaseTabulated) found.push_back(std::move(phase));
    found.emplace_back("long table", test::dropletTable(65536));
    std::vector<double> steep;
    for (int i = 0; i < 40; ++i) steep.push_back(std::pow(10.0, -i));
    found.emplace_back("table over 40 decades", test::tabulated(steep));
    return found;
}

TEST(TabulatedPhaseParity, SampleAgreesInEveryInterval) {
    // Quotients a, b 5 each and 10 in squares; the root takes half of 13 and 6; sum and two products 10, two quotients
    // 10, then width (5), sum and product, and a root of a product.
    constexpr double kAllowed = 45;
    Parity sample("volume/phase_function", "sampleTabulated", kAllowed);
    Stress stress(20);
    for (const PhaseCase& phase : tables()) {
        const shared::Medium& medium = phase.record();
        const float* table = phase.scene().phaseTable.data();
        std::vector<glm::vec4> inputs;
        for (const float u : test::stressUniforms(500)) {
            std::uint32_t interval = stress.word() % medium.phaseCount;
            while (table[interval] + table[interval + 1] == 0) interval = (interval + 1) % medium.phaseCount;
            addTo(inputs, u, 0, {0, 0, 1}, {0, 0, 1}, interval);
        }
        const auto outputs = run(kTable, inputs, phase.scene());
        for (std::size_t i = 0; i < outputs.size() / 2; ++i) {
            const auto interval = std::uint32_t(inputs[3 * i].z);
            const auto expected = reference::sampleTabulated<double>(
                table, medium.phaseCount, {interval, inputs[3 * i].x, 1.0 - inputs[3 * i].x});
            EXPECT_TRUE(sample.near(outputs[2 * i].x, expected.mu, 1)) << phase.name() << ' ' << i;
            EXPECT_TRUE(sample.near(outputs[2 * i].y, expected.sinTheta, std::max(expected.sinTheta, 1e-15)))
                << phase.name() << ' ' << i;
            EXPECT_TRUE(sample.near(outputs[2 * i].z, expected.pdf, std::max(expected.pdf, 1e-30)))
                << phase.name() << ' ' << i;
        }
    }
}

TEST(TabulatedPhaseParity, DensityAgreesH5) {
    // Distance from a pole, in intervals: a squared length and two products, 8, which move the value along the slopes
    // next to it; interpolation 4.
    Parity value("volume/phase_function", "evalTabulated", 8 + 4);
    Stress stress(21);
    for (const PhaseCase& phase : tables()) {
        const float* table = phase.scene().phaseTable.data();
        const std::uint32_t count = phase.record().phaseCount;
        float steepest = 0;
        for (std::uint32_t i = 0; i < count; ++i) steepest = std::max(steepest, std::abs(table[i + 1] - table[i]));
        std::vector<glm::vec4> inputs;
        for (int i = 0; i < 2'000; ++i) {
            const auto [wo, wi] = directionPair(stress);
            addTo(inputs, 0, 0, wo, wi);
        }
        const auto outputs = run(kTable, inputs, phase.scene());
        for (std::size_t i = 0; i < outputs.size() / 2; ++i) {
            const glm::dvec3 wo(inputs[3 * i + 1]), wi(inputs[3 * i + 2]);
            const double expected = reference::evalTabulated(table, count, wo, wi);
            const glm::dvec3 chord = glm::dot(wo, wi) < 0 ? wi + wo : wi - wo;
            const double fromPole = glm::dot(chord, chord) * count / 4;
            EXPECT_TRUE(value.near(outputs[2 * i + 1].x, expected, expected + steepest * fromPole + 1e-30))
                << phase.name() << ' ' << i;
        }
    }
}

// H8: the density of a sample is that of all lobes, whichever was chosen; both choices are met. Samples are placed
// about +z, or the direction of travel.
TEST(PhaseParity, EveryKindSamplesAndEvaluatesAlikeH7H8) {
    // Those of the kinds: 17 and 28 for one lobe, another density (28), two weights and a sum (5).
    Parity sample("volume/phase_function", "samplePhase", 17 + 28 + 5), value("volume/phase_function", "evalPhase", 33);
    std::vector<PhaseCase> all = test::newPhaseCases();
    all.emplace_back("isotropic", PhaseDescription{});
    all.emplace_back("one lobe", test::henyeyGreenstein(-0.6));
    Stress stress(22);
    for (const PhaseCase& phase : all) {
        const auto medium = phase.medium<double>();
        const bool isTable = medium.phase == shared::kPhaseTabulated;
        std::vector<glm::vec4> inputs;
        std::vector<std::uint32_t> words;
        for (const float u : test::stressUniforms(400)) {
            words.push_back(stress.word());
            addTo(inputs, u, 0, stress.direction(), stress.direction(), 0, words.back());
        }
        const auto outputs = run(kAny, inputs, phase.scene());
        for (std::size_t i = 0; i < words.size(); ++i) {
            const glm::dvec3 wo(inputs[3 * i + 1]), wi(inputs[3 * i + 2]);
            const double expected = reference::evalPhase(medium, wo, wi);
            EXPECT_TRUE(value.near(outputs[2 * i + 1].x, expected, isTable ? expected + 10 : expected)) << phase.name();
            const auto drawn =
                reference::samplePhase(medium, glm::dvec3(0, 0, -1), {test::wordOf(inputs[3 * i].x), 0}, words[i]);
            EXPECT_TRUE(sample.near(outputs[2 * i].x, drawn.direction.z, 1)) << phase.name() << ' ' << i;
            EXPECT_TRUE(sample.near(outputs[2 * i].z, drawn.pdf, std::max(drawn.pdf, 1e-30)))
                << phase.name() << ' ' << i;
        }
    }
}

}  // namespace
}  // namespace parhelion
