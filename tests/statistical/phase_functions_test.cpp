#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/volume/phase_function.h"
#include "support/goodness.h"
#include "support/phase_cases.h"
#include "support/words.h"

// Dual, Rayleigh and tabulated phase functions against closed-form distribution functions and moments.
// Henyey-Greenstein itself: samplers_test. Family: 10 functions, 10 x 4 moments, 200 bins, one rare lobe.
namespace parhelion::reference {
namespace {

using test::CellTest;
using test::dualHenyeyGreenstein;
using test::IndependentNumbers;
using test::partOf;
using test::PhaseCase;
using test::PhaseSampler;
using test::samplerOf;

constexpr std::size_t kTests = 52;

double significance() { return sidak(test::kFamilySignificance, kTests); }

CellTest scatterEqually(const PhaseCase& phase, const PhaseSampler& sampler, double share = 1) {
    return test::scatterIntoEqualCells(phase, sampler, significance(), share);
}

TEST(PhaseFunctions, FollowTheirDistributionFunctions) {
    for (const PhaseCase& phase : test::newPhaseCases())
        scatterEqually(phase, samplerOf(phase)).expectFit(phase.name());
}

TEST(PhaseFunctions, SeededDefectsAreCaught) {
    const auto expectCaught = [](const PhaseCase& right, const PhaseCase& wrong, double share = 0.25) {
        scatterEqually(right, samplerOf(wrong), share).expectMisfit(wrong.name());
    };
    const PhaseCase dual("dual", dualHenyeyGreenstein(0.85, -0.3, 0.7)), rayleigh("Rayleigh", test::rayleigh());
    expectCaught(dual, {"weight off by 0.01", dualHenyeyGreenstein(0.85, -0.3, 0.71)});
    expectCaught(dual, {"second g off by 0.02", dualHenyeyGreenstein(0.85, -0.32, 0.7)}, 1);
    expectCaught(dual, {"lobes swapped", dualHenyeyGreenstein(-0.3, 0.85, 0.7)}, 0.01);
    expectCaught(rayleigh, {"isotropic for Rayleigh", test::henyeyGreenstein(0)});
    const PhaseCase table("table", test::dropletTable(181));
    expectCaught(table,
                 {"sign of the table's cosine",
                  [] {
                      PhaseDescription phase = test::dropletTable(181);
                      std::ranges::reverse(phase.table);
                      return phase;
                  }()},
                 0.01);
    expectCaught({"table", test::tabulated({0, 1, 3})}, {"a value off by 2 %", test::tabulated({0, 1.02, 3})}, 1);
    const PhaseCase two("two intervals", test::tabulated({0, 1, 3}));
    const Medium<float> medium = two.medium<float>();
    scatterEqually(two, [&](const glm::vec3& wo, const glm::vec2& u, std::uint32_t choice) {
        glm::uvec2 words = test::wordsOf(u);
        words.x = test::bentWithin(two.scene().distributions, words.x, 0.05);
        return samplePhase(medium, wo, words, choice).direction;
    }).expectMisfit("what is left of the word within its interval bent by 5 %");
}

/// 20 x 10 cells of equal extent in (cos theta, phi).
CellTest scatterIntoBins(const PhaseCase& phase, const PhaseSampler& sampler, double share = 1) {
    constexpr std::size_t kCosines = 20, kAngles = 10;
    std::vector<double> probabilities;
    for (std::size_t i = 0; i < kCosines; ++i) {
        const double part = phase.cdf(2 - 2 * double(i + 1) / kCosines) - phase.cdf(2 - 2 * double(i) / kCosines);
        probabilities.insert(probabilities.end(), kAngles, part / kAngles);
    }
    const auto cellOf = [](double oneMinusMu, double turn) {
        return partOf(1 - oneMinusMu / 2, kCosines) * kAngles + partOf(turn, kAngles);
    };
    return test::scatterInto(CellTest(probabilities, significance()), cellOf, sampler, share);
}

// The baseline's test of this name, there with 200 000 samples at 1 %.
TEST(BaselineDualHenyeyGreenstein, ChiSquareIn200BinsOfCosThetaAndPhi) {
    const PhaseCase phase("dual", dualHenyeyGreenstein(0.85, -0.3, 0.7));
    scatterIntoBins(phase, samplerOf(phase)).expectFit(phase.name());
    const PhaseCase wrong("weight off by 0.01", dualHenyeyGreenstein(0.85, -0.3, 0.71));
    scatterIntoBins(phase, samplerOf(wrong), 0.25).expectMisfit(wrong.name());
}

// H7: a lobe keeps its shape however rarely it is chosen. With the choosing number rescaled, which is what most do, a
// lobe of weight 2^-20 has 16 directions left.
TEST(PhaseFunctions, RareLobesKeepTheirShapeH7) {
    const float weight = 0x1p-20f;
    const PhaseCase rare("rare", dualHenyeyGreenstein(0.9, -0.5, weight)), lobe("lobe", test::henyeyGreenstein(0.9));
    const Medium<float> medium = rare.medium<float>();
    scatterEqually(lobe, [&](const glm::vec3& wo, const glm::vec2& u, std::uint32_t word) {
        return samplePhase(medium, wo, test::wordsOf(u), word >> 20).direction;
    }).expectFit("lobe of weight 2^-20");
    const Medium<float> single = lobe.medium<float>();
    scatterEqually(
        lobe,
        [&](const glm::vec3& wo, const glm::vec2& u, std::uint32_t) {
            const float rescaled = std::floor(u.x * weight * 0x1p24f) * 0x1p-24f / weight;
            return samplePhase(single, wo, test::wordsOf(glm::vec2(rescaled, u.y)), 0).direction;
        },
        0.25)
        .expectMisfit("one number chooses the lobe and the direction");
}

std::array<RunningMoments, 4> legendreMoments(const PhaseCase& phase, int count) {
    std::array<RunningMoments, 4> moments;
    const Medium<float> medium = phase.medium<float>();
    IndependentNumbers numbers(12);
    for (int i = 0; i < count; ++i) {
        const glm::uvec4 words = numbers.words();
        const auto direction = samplePhase(medium, glm::vec3(0, 0, -1), words, words.z).direction;
        const auto values = test::legendre(double(direction.z));
        for (int l = 0; l < 4; ++l) moments[l].add(values[l]);
    }
    return moments;
}

TEST(PhaseFunctions, LegendreMomentsAreThoseOfTheFormula) {
    // The largest deviation, 0.66, takes 5 million for 0.0023: 0.5 % of every moment above 0.46. Of smaller ones that
    // would be 100 million each.
    for (const PhaseCase& phase : test::newPhaseCases()) {
        const auto moments = legendreMoments(phase, 5'000'000);
        for (unsigned l = 1; l <= 4; ++l)
            test::expectResolvedMean(moments[l - 1], phase.legendreMoment(l), significance(),
                                     fmt::format("{}, l {}", phase.name(), l), 0.47);
    }
    // A second moment or a first one that is 0.01 off shows.
    const auto found = [](const PhaseCase& phase) { return legendreMoments(phase, 1'000'000); };
    EXPECT_FALSE(test::agrees(found({"Rayleigh", test::rayleigh()})[1], 0.11, significance())) << "seeded defect";
    const PhaseCase wrong("weight off by 0.01", dualHenyeyGreenstein(0.85, -0.3, 0.71));
    EXPECT_FALSE(test::agrees(found(wrong)[0], 0.7 * 0.85 - 0.3 * 0.3, significance())) << wrong.name();
    std::vector<double> reversed = test::dropletTable(181).table;
    std::ranges::reverse(reversed);
    EXPECT_FALSE(test::agrees(found({"reversed", test::tabulated(reversed)})[0],
                              PhaseCase("table", test::dropletTable(181)).legendreMoment(1), significance()));
}

}  // namespace
}  // namespace parhelion::reference
