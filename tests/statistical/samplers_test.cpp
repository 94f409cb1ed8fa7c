#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "reference/surface/bsdf.h"
#include "reference/volume/phase_function.h"
#include "support/goodness.h"

// Directions and points against closed-form distribution functions. Family: 7 phase functions, 7 x 4 moments, 8 warps,
// 3 normals.
namespace parhelion::reference {
namespace {

using test::CellTest;
using test::IndependentNumbers;
using test::partOf;
using test::turnOf;

constexpr std::array kAsymmetries{-0.9, -0.3, 0.0, 1e-4, 0.5, 0.9, 0.999};
constexpr std::size_t kTests = 48;
constexpr std::size_t kPolar = 6, kAzimuth = 3;

double significance() { return sidak(test::kFamilySignificance, kTests); }

Medium<float> mediumOf(double g, bool isotropic = false) {
    Medium<float> medium{};
    medium.g = float(g);
    medium.phase = isotropic ? shared::kPhaseIsotropic : shared::kPhaseHenyeyGreenstein;
    return medium;
}

/// Distribution function of mu, from 1 - mu (which is known better near the peak):
/// (1 - g^2) / 2g (1 / s - 1 / (1 + g)) with s^2 = 1 + g^2 - 2 g mu, its pole at g = 0 divided out.
double henyeyGreensteinCdf(double g, double oneMinusMu) {
    const double s = std::sqrt((1 - g) * (1 - g) + 2 * g * oneMinusMu);
    return (1 - g) * (2 - oneMinusMu) / (s * (1 + g + s));
}

using PhaseSampler = std::function<glm::vec3(const glm::vec3& wo, const glm::vec2& u)>;

/// Scatters a skew ray and bins the outcomes by distribution function and azimuth about the direction of travel.
/// @param share  of the samples that a distortion of half a percent needs; seeded defects are larger.
CellTest scatterInto(double g, const PhaseSampler& sampler, double share = 1) {
    CellTest cells(kPolar * kAzimuth, significance());
    const glm::vec3 wo = glm::normalize(glm::vec3(0.3f, -0.5f, 0.7f));
    const glm::dvec3 travel = -glm::normalize(glm::dvec3(wo));
    const glm::dvec3 side = glm::normalize(glm::cross(travel, glm::dvec3(1, 0, 0))), up = glm::cross(travel, side);
    IndependentNumbers numbers(1);
    for (auto i = std::uint64_t(share * double(cells.samplesNeeded())); i > 0; --i) {
        const glm::dvec3 wi(sampler(wo, numbers.pair<float>()));
        const glm::dvec3 chord = wi - travel;
        const double polar = henyeyGreensteinCdf(g, glm::dot(chord, chord) / 2);
        cells.add(partOf(polar, kPolar) * kAzimuth + partOf(turnOf(glm::dot(wi, side), glm::dot(wi, up)), kAzimuth));
    }
    return cells;
}

PhaseSampler phaseSampler(const Medium<float>& medium) {
    return [medium](const glm::vec3& wo, const glm::vec2& u) { return samplePhase(medium, wo, u, 0).direction; };
}

TEST(PhaseSampling, FollowsTheClosedFormDistribution) {
    for (const double g : kAsymmetries) {
        const Medium<float> medium = mediumOf(g);
        scatterInto(double(medium.g), phaseSampler(medium)).expectFit("g " + std::to_string(g));
    }
    scatterInto(0, phaseSampler(mediumOf(0, true))).expectFit("isotropic");
}

TEST(PhaseSampling, SeededDefectsAreCaught) {
    for (const double g : kAsymmetries)
        scatterInto(g, phaseSampler(mediumOf(g + (g > 0.5 ? -0.01 : 0.01))), 0.25).expectMisfit("g off by 0.01");
    scatterInto(0.5, phaseSampler(mediumOf(-0.5)), 0.01).expectMisfit("wo taken for the direction of travel");
    const Medium<float> medium = mediumOf(0.5);
    scatterInto(
        0.5,
        [&](const glm::vec3& wo, const glm::vec2& u) {
            return samplePhase(medium, wo, {u.x, 0.99f * u.y}, 0).direction;
        },
        0.25)
        .expectMisfit("a slice of azimuths left out");
}

TEST(PhaseSampling, LegendreMomentsArePowersOfTheAsymmetry) {
    for (const double exact : kAsymmetries) {
        const auto g = double(float(exact));
        std::array<RunningMoments, 4> moments;
        IndependentNumbers numbers(2);
        for (int i = 0; i < 2'000'000; ++i) {
            const double mu = sampleHenyeyGreenstein(float(g), numbers.uniform<float>()).mu, mu2 = mu * mu;
            const std::array legendre{mu, (3 * mu2 - 1) / 2, (5 * mu2 - 3) * mu / 2,
                                      (35 * mu2 * mu2 - 30 * mu2 + 3) / 8};
            for (int l = 0; l < 4; ++l) moments[l].add(legendre[l]);
        }
        for (int l = 0; l < 4; ++l)
            test::expectMean(moments[l], std::pow(g, l + 1), significance(),
                             "g " + std::to_string(g) + " l " + std::to_string(l + 1));
        EXPECT_FALSE(test::agrees(moments[0], g + (g > 0.5 ? -0.01 : 0.01), significance())) << "seeded defect";
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
CellTest warpInto(const Warp& cellOf) {
    CellTest cells(kPolar * kAzimuth, significance());
    IndependentNumbers numbers(4);
    for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) cells.add(cellOf(numbers.pair<float>()));
    return cells;
}

std::size_t cellAbout(double polar, const glm::vec3& d) {
    return partOf(polar, kPolar) * kAzimuth + partOf(turnOf(d.x, d.y), kAzimuth);
}

/// Squared sine to +z: the distribution function of cosine-weighted directions.
double sine2(const glm::vec3& d) { return double(d.x) * d.x + double(d.y) * d.y; }

TEST(Warps, CosineHemisphereHasDensityCosineOverPi) {
    const auto cell = [](const glm::vec3& d) { return cellAbout(sine2(d), d); };
    warpInto([&](const glm::vec2& u) { return cell(cosineHemisphere(u)); }).expectFit("cosine");
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

TEST(Warps, SphereIsUniform) {
    warpInto([](const glm::vec2& u) {
        const glm::vec3 d = uniformSphere(u);
        return cellAbout((1 - double(d.z)) / 2, d);
    }).expectFit("sphere");
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
        warpInto([&](const glm::vec2& u) { return cell(uniformCone(u, width)); }).expectFit("cone");
        warpInto([&](const glm::vec2& u) {
            return cell(uniformCone({u.x * u.x, u.y}, width));
        }).expectMisfit("uniform in the angle");
    }
}

TEST(Warps, TrianglesAreUniform) {
    // 36 congruent triangles: a square grid of the barycentric plane, each square cut along its diagonal.
    const auto cell = [](const glm::vec3& b) {
        const double x = 6.0 * b.y, y = 6.0 * b.z;
        const int i = std::min(int(x), 5), j = std::min(int(y), 5 - i);
        const bool upper = i + j < 5 && x - i + y - j > 1;
        // Row i holds 2 (5 - i) + 1 cells.
        return std::size_t(i * (12 - i)) + std::size_t(2 * j) + (upper ? 1u : 0u);
    };
    const auto run = [&](auto sampler) {
        CellTest cells(36, significance());
        IndependentNumbers numbers(5);
        for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) cells.add(cell(sampler(numbers.pair<float>())));
        return cells;
    };
    run([](const glm::vec2& u) { return uniformTriangle(u); }).expectFit("triangle");
    run([](const glm::vec2& u) { return glm::vec3(1 - u.x, u.y * u.x, u.x - u.y * u.x); }).expectMisfit("no root");
}

}  // namespace
}  // namespace parhelion::reference
