#include <gtest/gtest.h>

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "reference/sampling/sampler.h"
#include "reference/volume/phase_function.h"
#include "support/phase_cases.h"
#include "support/words.h"

namespace parhelion::reference {
namespace {

using test::henyeyGreenstein;
using test::newPhaseCases;
using test::PhaseCase;

constexpr std::array kAsymmetries{-0.999999, -0.99, -0.85, -0.5, -1e-4, 0.0,   1e-4,    1e-3,
                                  0.3,       0.6,   0.85,  0.9,  0.99,  0.999, 0.999999};

/// Enough digits for the textbook forms, which lose most of them as |g| goes to 1.
using Exact = boost::multiprecision::cpp_bin_float_50;

/// Textbook Henyey-Greenstein density per steradian.
double textbookDensity(const Exact& g, const Exact& mu) {
    const Exact squared = 1 + g * g - 2 * g * mu;
    return double((1 - g * g) / (4 * std::numbers::pi * squared * sqrt(squared)));
}

/// Inversion of the distribution function: mu for u; its singularity at g = 0 is divided out by hand.
Exact textbookMu(const Exact& g, const Exact& u) {
    const Exact v = 2 * u - 1;
    const Exact k = 1 + g * v;
    return (v + g * (3 + v * v) / 2 + g * g * v + g * g * g * (v * v - 1) / 2) / (k * k);
}

Medium<double> mediumOf(double g) {
    Medium<double> m{};
    m.g = g;
    m.phase = shared::kPhaseHenyeyGreenstein;
    return m;
}

TEST(ReferencePhase, SampledAnglesAndDensitiesHoldUpToExtremeAsymmetry) {  // H1, H2, H3
    for (const double exact : kAsymmetries) {
        const auto g = float(exact);
        for (int i = 0; i < 4096; ++i) {
            const float u = (float(i) + 0.5f) / 4096;
            const Deflection<float> d = sampleHenyeyGreenstein(g, u);
            // At most 16 roundings of 2^-24 each (accuracy: c * 2^-24 with c the operation count).
            const Exact mu = textbookMu(g, u);
            EXPECT_NEAR(d.mu, double(mu), 1e-6) << "g " << g << " u " << u;
            EXPECT_NEAR(d.sinTheta / double(sqrt((1 - mu) * (1 + mu))), 1, 1e-6) << "g " << g << " u " << u;
            EXPECT_NEAR(d.pdf / textbookDensity(g, mu), 1, 1e-6) << "g " << g << " u " << u;
        }
    }
}

TEST(ReferencePhase, EndsOfTheUnitIntervalGiveUnitDirections) {  // H4
    for (const double g : kAsymmetries)
        for (const float u : {0.0f, 1 - 0x1p-24f}) {
            const Deflection<float> d = sampleHenyeyGreenstein(float(g), u);
            EXPECT_NEAR(d.mu * d.mu + d.sinTheta * d.sinTheta, 1, 4e-7) << "g " << g << " u " << u;
            EXPECT_LE(std::abs(d.mu), 1.0f);
            EXPECT_TRUE(std::isfinite(d.pdf));
        }
}

TEST(ReferencePhase, EvaluationHoldsAtThePeak) {  // H5
    for (const double exact : kAsymmetries) {
        const auto g = float(exact);
        for (const float angle : {0.0f, 1e-6f, 1e-3f, 0.5f, 3.1415927f}) {
            const glm::vec3 wo{0, 0, -1}, wi{std::sin(angle), 0, std::cos(angle)};
            const glm::dvec3 exactWo(wo), exactWi(wi);
            const double value = evalHenyeyGreenstein(double(g), exactWo, exactWi);
            EXPECT_NEAR(evalHenyeyGreenstein(g, wo, wi) / value, 1, 1e-6) << "g " << g << " angle " << angle;
        }
    }
    // Against the textbook, where that has digits left.
    const double mu = std::cos(0.5);
    EXPECT_NEAR(
        evalHenyeyGreenstein(0.85, glm::dvec3(0, 0, -1), glm::dvec3(std::sin(0.5), 0, mu)) / textbookDensity(0.85, mu),
        1, 1e-14);
}

TEST(ReferencePhase, SampledDirectionsHaveTheDensityThatEvaluationGives) {  // H8's form for one lobe
    for (const double g : {-0.85, 0.0, 0.6, 0.99}) {
        const Medium<double> medium = mediumOf(g);
        const glm::dvec3 wo = glm::normalize(glm::dvec3(0.3, -0.5, 0.7));
        glm::uvec4 words{9, 8, 7, 6};
        for (int i = 0; i < 1000; ++i) {
            words = pcg4d(words);
            const DirectionSample<double> sample = samplePhase(medium, wo, words, 0);
            EXPECT_NEAR(sample.pdf / evalPhase(medium, wo, sample.direction), 1, 1e-9);
            EXPECT_NEAR(glm::length(sample.direction), 1, 1e-15);
        }
    }
}

TEST(ReferencePhase, MeanCosineOfTravelIsG) {  // H3, H6, H9: E[P_l(mu)] = g^l, mu between travel directions
    constexpr int kCount = 4096;
    for (const double g : {-0.6, 1e-4, 1e-3, 0.6, 0.9}) {
        const Medium<double> medium = mediumOf(g);
        double first = 0, second = 0;
        for (int i = 0; i < kCount; ++i) {
            const glm::dvec3 wo{0, 1, 0};
            const double mu =
                glm::dot(-wo, samplePhase(medium, wo, {test::wordOf((i + 0.5) / kCount), 0}, 0).direction);
            first += mu;
            second += 1.5 * mu * mu - 0.5;
        }
        // Midpoint rule: error h^2 / 24 times the slope of mu at the ends, at most 2 (1 + |g|) / (1 - |g|) = 38.
        EXPECT_NEAR(first / kCount, g, 1e-6);
        EXPECT_NEAR(second / kCount, g * g, 1e-6);
    }
}

TEST(ReferencePhase, DensityIntegratesToOne) {  // H6: composite Simpson over mu
    for (const double g : {-0.85, 0.0, 0.5, 0.95}) {
        constexpr int kSteps = 40000;
        double sum = 0;
        for (int i = 0; i <= kSteps; ++i) {
            const double mu = -1 + 2.0 * i / kSteps;
            const glm::dvec3 wi{std::sqrt(1 - mu * mu), 0, mu};
            const int weight = i == 0 || i == kSteps ? 1 : (i % 2 ? 4 : 2);
            sum += weight * evalHenyeyGreenstein(g, glm::dvec3(0, 0, -1), wi);
        }
        EXPECT_NEAR(2 * kPi<double> * sum * (2.0 / kSteps) / 3, 1, 1e-6) << g;
    }
}

TEST(ReferencePhase, TenThousandScatteringsKeepDirectionsUnit) {  // H11
    std::vector<PhaseCase> all = newPhaseCases();
    all.emplace_back("one lobe", henyeyGreenstein(0.85));
    for (const PhaseCase& phase : all) {
        const Medium<float> medium = phase.medium<float>();
        glm::vec3 direction{0, 0, 1};
        glm::uvec4 words{3, 3, 3, 3};
        for (int i = 0; i < 10000; ++i) {
            words = pcg4d(words);
            direction = samplePhase(medium, -direction, words, words.z).direction;
            ASSERT_NEAR(glm::length(glm::dvec3(direction)), 1, 2e-7) << phase.name();
        }
    }
}

/// Cosines at both poles, next to them and between, as unit vectors can give them.
std::vector<glm::dvec3> directionsAtManyCosines() {
    std::vector<glm::dvec3> directions;
    for (const double angle : {0.0, 1e-6, 1e-3, 0.1, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.14, 3.1415926})
        directions.push_back(glm::normalize(glm::dvec3(std::sin(angle), 0, std::cos(angle))));
    return directions;
}

// H5, H9: against the textbook forms, in double; mu between directions of travel. A table is stored in float.
TEST(ReferencePhase, EveryFunctionIsThatOfItsFormulaH5H9) {
    for (const PhaseCase& phase : newPhaseCases()) {
        const Medium<double> medium = phase.medium<double>();
        const double tolerance = phase.record().phase == shared::kPhaseTabulated ? 1e-6 : 1e-9;
        for (const glm::dvec3& wi : directionsAtManyCosines()) {
            const double exact = phase.density(wi.z);
            EXPECT_NEAR(evalPhase(medium, glm::dvec3(0, 0, -1), wi), exact, tolerance * (exact + 1e-3))
                << phase.name() << " mu " << wi.z;
        }
    }
}

TEST(ReferencePhase, EveryFunctionsMomentsAreThoseOfItsFormulaH6) {
    constexpr int kSteps = 100000;
    for (const PhaseCase& phase : newPhaseCases()) {
        const Medium<double> medium = phase.medium<double>();
        std::array<double, 9> moments{};
        // Midpoints in the angle: errors of about (step / width)^2 / 24 of a peak's share; widths are 0.01 and, of the
        // peak of weight 2^-10, 0.001: 4e-7 and 4e-8.
        for (int i = 0; i < kSteps; ++i) {
            const double angle = kPi<double> * (i + 0.5) / kSteps;
            const glm::dvec3 wi{std::sin(angle), 0, std::cos(angle)};
            const double part =
                evalPhase(medium, glm::dvec3(0, 0, -1), wi) * wi.x * 2 * kPi<double> * kPi<double> / kSteps;
            for (unsigned l = 0; l < moments.size(); ++l) moments[l] += part * std::legendre(l, wi.z);
        }
        for (unsigned l = 0; l < moments.size(); ++l)
            EXPECT_NEAR(moments[l], phase.legendreMoment(l), 1e-6) << phase.name() << " l " << l;
    }
}

TEST(ReferencePhase, EndsOfTheUnitIntervalGiveUnitDirectionsForEveryFunctionH4) {
    for (const PhaseCase& phase : newPhaseCases()) {
        const Medium<float> medium = phase.medium<float>();
        for (const float u : {0.0f, 0x1p-24f, 0.5f, 1 - 0x1p-24f})
            for (const std::uint32_t word : {0u, 0x7fffffffu, 0x80000000u, 0xffffffffu}) {
                const auto sample = samplePhase(medium, glm::vec3(0, 0, -1), {test::wordOf(u), 0}, word);
                EXPECT_NEAR(glm::length(glm::dvec3(sample.direction)), 1, 2e-7) << phase.name();
                EXPECT_TRUE(std::isfinite(sample.pdf) && sample.pdf >= 0) << phase.name();
            }
    }
}

// H8: the density is the mixture's, not that of the lobe chosen: it is the density of the direction that came out.
TEST(ReferencePhase, EverySampledDirectionHasTheDensityThatEvaluationGivesH8) {
    for (const PhaseCase& phase : newPhaseCases()) {
        const Medium<double> medium = phase.medium<double>();
        const glm::dvec3 wo = glm::normalize(glm::dvec3(0.3, -0.5, 0.7));
        glm::uvec4 words{9, 8, 7, 6};
        for (int i = 0; i < 1000; ++i) {
            words = pcg4d(words);
            const DirectionSample<double> sample = samplePhase(medium, wo, words, words.z);
            EXPECT_NEAR(sample.pdf, evalPhase(medium, wo, sample.direction), 1e-9 * (sample.pdf + 1)) << phase.name();
        }
    }
}

}  // namespace
}  // namespace parhelion::reference
