#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "reference/surface/bsdf.h"
#include "reference/volume/phase_function.h"
#include "support/phase_cases.h"
#include "support/words.h"

// Directions and points against closed-form distribution functions. Family: 8 phase functions, 7 x 4 moments, 9 warps
// and directions, 3 x 2 moments of cosines.
namespace parhelion::reference {
namespace {

using test::CellTest;
using test::IndependentNumbers;
using test::partOf;
using test::PhaseCase;
using test::PhaseSampler;
using test::turnOf;

constexpr std::array kAsymmetries{-0.9, -0.3, 0.0, 1e-4, 0.5, 0.9, 0.999};
constexpr std::size_t kTests = 52;
constexpr std::size_t kPolar = 6, kAzimuth = 3;

double significance() { return sidak(test::kFamilySignificance, kTests); }

PhaseCase phaseCase(double g) { return {fmt::format("g {}", g), test::henyeyGreenstein(g)}; }

CellTest scatterEqually(const PhaseCase& phase, const PhaseSampler& sampler, double share = 1) {
    return test::scatterIntoEqualCells(phase, sampler, significance(), share);
}

TEST(PhaseSampling, FollowsTheClosedFormDistribution) {
    for (const double g : kAsymmetries) {
        const PhaseCase phase = phaseCase(g);
        scatterEqually(phase, samplerOf(phase)).expectFit(phase.name());
    }
    Medium<float> isotropic{};
    isotropic.phase = shared::kPhaseIsotropic;
    scatterEqually(phaseCase(0), [&](const glm::vec3& wo, const glm::vec2& u, std::uint32_t choice) {
        return samplePhase(isotropic, wo, test::wordsOf(u), choice).direction;
    }).expectFit("isotropic");
}

TEST(PhaseSampling, SeededDefectsAreCaught) {
    for (const double g : kAsymmetries)
        scatterEqually(phaseCase(g), samplerOf(phaseCase(g + (g > 0.5 ? -0.01 : 0.01))), 0.25)
            .expectMisfit(fmt::format("g {} off by 0.01", g));
    const PhaseCase forward = phaseCase(0.5);
    scatterEqually(forward, samplerOf(phaseCase(-0.5)), 0.01).expectMisfit("wo taken for the direction of travel");
    const PhaseSampler sampler = samplerOf(forward);
    scatterEqually(
        forward,
        [&](const glm::vec3& wo, const glm::vec2& u, std::uint32_t choice) {
            return sampler(wo, {u.x, 0.99f * u.y}, choice);
        },
        0.25)
        .expectMisfit("a slice of azimuths left out");
}

TEST(PhaseSampling, LegendreMomentsArePowersOfTheAsymmetry) {
    for (const double exact : kAsymmetries) {
        const auto g = double(float(exact));
        std::array<RunningMoments, 4> moments;
        IndependentNumbers numbers(2);
        // The largest deviation, 0.58 of mu at g = 0, takes 8 million for 0.0017: 0.5 % of every moment above 0.35. Of
        // smaller ones that would be 100 million each.
        for (int i = 0; i < 8'000'000; ++i) {
            const auto values = test::legendre(double(sampleHenyeyGreenstein(float(g), numbers.uniform<float>()).mu));
            for (int l = 0; l < 4; ++l) moments[l].add(values[l]);
        }
        for (int l = 0; l < 4; ++l)
            test::expectResolvedMean(moments[l], std::pow(g, l + 1), significance(),
                                     fmt::format("g {}, l {}", exact, l + 1), 0.35);
        EXPECT_FALSE(test::agrees(moments[0], g + (g > 0.5 ? -0.01 : 0.01), significance())) << "g off by 0.01";
    }
}

// H3: the inversion of the textbooks in float, which divides by 2 g.
TEST(PhaseSampling, TextbookInversionLeavesTheUnitIntervalAtSmallAsymmetry) {
    const auto textbook = [](float g, float u) {
        const float a = (1 - g * g) / (1 - g + 2 * g * u);
        return (1 + g * g - a * a) / (2 * g);
    };
    IndependentNumbers numbers(3);
    int outside = 0;
    for (int i = 0; i < 10'000; ++i) {
        const auto u = numbers.uniform<float>();
        outside += std::abs(textbook(1e-7f, u)) > 1;
        EXPECT_LE(std::abs(sampleHenyeyGreenstein(1e-7f, u).mu), 1.0f);
    }
    EXPECT_GT(outside, 1000);
}

template <typename Warp>
CellTest warpInto(const Warp& cellOf, std::size_t count = kPolar * kAzimuth, const glm::dvec2& bends = glm::dvec2(0)) {
    CellTest cells(count, significance());
    IndependentNumbers numbers(4);
    for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i)
        cells.add(cellOf(test::bent(numbers.pair<float>(), bends)));
    return cells;
}

/// Expects that the warp fits, and that it does not when the density of either number is bent by 2 %.
template <typename Warp>
void expectWarp(const std::string& what, const Warp& cellOf, std::size_t count = kPolar * kAzimuth) {
    warpInto(cellOf, count).expectFit(what);
    warpInto(cellOf, count, {0.02, 0}).expectMisfit(what + ", first number bent by 2 %");
    warpInto(cellOf, count, {0, 0.02}).expectMisfit(what + ", second number bent by 2 %");
}

std::size_t cellAbout(double polar, const glm::vec3& d) {
    return partOf(polar, kPolar) * kAzimuth + partOf(turnOf(d.x, d.y), kAzimuth);
}

/// Squared sine to +z: the distribution function of cosine-weighted directions.
double sine2(const glm::vec3& d) { return double(d.x) * d.x + double(d.y) * d.y; }

TEST(Warps, CosineHemisphereHasDensityCosineOverPi) {
    const auto cell = [](const glm::vec3& d) { return cellAbout(sine2(d), d); };
    expectWarp("cosine", [&](const glm::vec2& u) { return cell(cosineHemisphere(u)); });
    warpInto([&](const glm::vec2& u) { return cell(uniformCone(u, 1.0f)); }).expectMisfit("without the cosine");
}

using DiffuseSampler = std::function<glm::vec3(const glm::vec3& normal, const glm::vec2& u)>;

/// Cells of equal probability by squared sine to the normal and azimuth about it; normals on both hemispheres and -z.
CellTest reflectInto(const glm::vec3& normal, const DiffuseSampler& sampler) {
    const glm::dvec3 n(normal), side = glm::normalize(glm::cross(n, glm::dvec3(0.1, 1, 0))), up = glm::cross(n, side);
    return warpInto([&](const glm::vec2& u) {
        const glm::dvec3 d(sampler(normal, u));
        const double x = glm::dot(d, side), y = glm::dot(d, up);
        return partOf(x * x + y * y, kPolar) * kAzimuth + partOf(turnOf(x, y), kAzimuth);
    });
}

TEST(DiffuseSampling, HasDensityCosineOverPiAboutEveryNormal) {
    const DiffuseSampler sampler = [](const auto& normal, const auto& u) { return sampleDiffuse(normal, u).direction; };
    for (const glm::vec3 direction : {glm::vec3(0.3f, -0.5f, 0.7f), glm::vec3(1, 2, -0.01f), glm::vec3(0, 0, -1)}) {
        const glm::vec3 normal = glm::normalize(direction);
        reflectInto(normal, sampler).expectFit("diffuse");
        IndependentNumbers numbers(8);
        for (int i = 0; i < 10'000; ++i) {
            const DirectionSample<float> sample = sampleDiffuse(normal, numbers.pair<float>());
            // The frame, the product and the normalisation round: 8 roundings of numbers up to 1.
            const float exact = float(glm::dot(glm::dvec3(normal), glm::dvec3(sample.direction)) / std::numbers::pi);
            ASSERT_NEAR(sample.pdf, exact, 8 * 0x1p-24f);
            ASSERT_NEAR(pdfDiffuse(normal, sample.direction), exact, 8 * 0x1p-24f);
        }
    }
    const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, -0.5f, 0.7f));
    reflectInto(normal, [&](const glm::vec3& n, const glm::vec2& u) {
        return sampler(glm::normalize(n + glm::vec3(0.01f, 0, 0)), u);
    }).expectMisfit("a normal off by half a degree");
    reflectInto(normal, [](const glm::vec3& n, const glm::vec2& u) {
        return toWorld(frameFromNormal(n), uniformCone(u, 1.0f));
    }).expectMisfit("without the cosine");
}

TEST(DiffuseSampling, CosinesHaveTheMomentsOfLambertsLaw) {
    // E[cos] = 2/3 and E[cos^2] = 1/2, with deviations 1 / sqrt(18) and 1 / sqrt(12): 850 000 samples for 0.5 %.
    for (const glm::vec3 direction : {glm::vec3(0.3f, -0.5f, 0.7f), glm::vec3(1, 2, -0.01f), glm::vec3(0, 0, -1)}) {
        const glm::vec3 normal = glm::normalize(direction);
        const glm::dvec3 n = glm::normalize(glm::dvec3(normal));
        RunningMoments cosines, squares, defect;
        IndependentNumbers numbers(9);
        for (int i = 0; i < 1'000'000; ++i) {
            const glm::vec2 u = numbers.pair<float>();
            const double cosine = glm::dot(n, glm::dvec3(sampleDiffuse(normal, u).direction));
            cosines.add(cosine);
            squares.add(cosine * cosine);
            defect.add(glm::dot(n, glm::dvec3(sampleDiffuse(normal, test::bent(u, {0.02, 0})).direction)));
        }
        test::expectResolvedMean(cosines, 2 / 3.0, significance(), "cosine");
        test::expectResolvedMean(squares, 0.5, significance(), "squared cosine");
        EXPECT_FALSE(test::agrees(defect, 2 / 3.0, significance())) << "first number bent by 2 %";
    }
}

TEST(Warps, SphereIsUniform) {
    expectWarp("sphere", [](const glm::vec2& u) {
        const glm::vec3 d = uniformSphere(u);
        return cellAbout((1 - double(d.z)) / 2, d);
    });
    warpInto([](const glm::vec2& u) {
        const float angle = float(kPi<float>) * u.x;
        return cellAbout((1 - std::cos(angle)) / 2.0, {std::cos(6.28f * u.y), std::sin(6.28f * u.y), 0});
    }).expectMisfit("uniform in the angle");
}

TEST(Warps, ConesAreUniformFromTheSunsToTheHemisphere) {
    for (const float width : {1.08e-5f, 0.1f, 1.0f}) {
        const auto cell = [&](const glm::vec3& d) {
            const double oneMinusCos = sine2(d) / (1 + std::sqrt(std::max(0.0, 1 - sine2(d))));
            return cellAbout(oneMinusCos / width, d);
        };
        expectWarp(fmt::format("cone of {}", width), [&](const glm::vec2& u) { return cell(uniformCone(u, width)); });
        warpInto([&](const glm::vec2& u) {
            return cell(uniformCone({u.x * u.x, u.y}, width));
        }).expectMisfit("uniform in the angle");
    }
}

TEST(Warps, TrianglesAreUniform) {
    const auto cell = [](const glm::vec3& b) { return test::triangleCell(double(b.y), double(b.z)); };
    expectWarp(
        "triangle", [&](const glm::vec2& u) { return cell(uniformTriangle(u)); }, 36);
    warpInto(
        [&](const glm::vec2& u) {
            return cell({1 - u.x, u.y * u.x, u.x - u.y * u.x});
        },
        36)
        .expectMisfit("no root");
}

}  // namespace
}  // namespace parhelion::reference
