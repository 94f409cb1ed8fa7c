#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "compile/luminance.h"
#include "reference/light/environment.h"
#include "support/environment_maps.h"
#include "support/goodness.h"
#include "support/hand_scene.h"
#include "support/words.h"

// Sampled directions of environment maps against the laws they must follow, and light sampling against scattering
// alone.
namespace parhelion::reference {
namespace {

using test::CellTest;
using test::HandScene;
using test::partOf;

// Five fits of cells and within cells, three solid angles, two irradiances, two floors, three comparisons: 15.
double significance() { return sidak(test::kFamilySignificance, 24); }

constexpr glm::uvec2 kSmall{64, 32}, kLarge{4096, 2048};  // both ends of the sizes of maps

HandScene mapScene(const EmitterDescription& map) {
    HandScene scene;
    scene.setEnvironmentMap(map);
    return scene;
}

/// Solid angle of the cells of a row, from the angles of its edges.
double solidAngle(glm::uvec2 size, std::uint32_t row) {
    const double step = kPi<double> / (size.y - 1);
    return 2 * kPi<double> / size.x * 2 * std::sin(step * (row + 0.5)) * std::sin(0.5 * step);
}

glm::dvec3 cellCentre(glm::uvec2 size, std::uint32_t column, std::uint32_t row) {
    const double turn = 2 * kPi<double> * (column + 1.0) / size.x, angle = kPi<double> * (row + 0.5) / (size.y - 1);
    return {std::sin(turn) * std::sin(angle), std::cos(angle), -std::cos(turn) * std::sin(angle)};
}

/// Which of 32 tiles, or of the 9 cells in and around the bright texel's, a cell belongs to.
std::size_t binOf(glm::uvec2 size, std::uint32_t column, std::uint32_t row) {
    const glm::uvec2 hot = size / 3u - 1u;  // first of the four cells
    if (column + 1 >= hot.x && column <= hot.x + 1 && row + 1 >= hot.y && row <= hot.y + 1)
        return 32 + (column + 1 - hot.x) * 3 + (row + 1 - hot.y);
    return column * 8 / size.x * 4 + row * 4 / size.y;
}

/// Chances of the bins: the density as directions look it up, times solid angles.
std::vector<double> binChances(const SceneView<double>& view, glm::uvec2 size) {
    std::vector<double> chances(41, 0.0);
    for (std::uint32_t row = 0; row + 1 < size.y; ++row)
        for (std::uint32_t column = 0; column < size.x; ++column)
            chances[binOf(size, column, row)] +=
                environmentAt(view, cellCentre(size, column, row)).pdf * solidAngle(size, row);
    return chances;
}

// With a sun of 1e6 in one texel (H44, H57) and without.
TEST(EnvironmentSampling, CellsAreFoundAsTheirDensitySays) {
    struct Case {
        glm::uvec2 size;
        bool isHot;
    };
    for (const auto [size, isHot] : {Case{kSmall, true}, Case{kSmall, false}, Case{kLarge, true}}) {
        const HandScene built = mapScene(test::madeMap(size, 0, isHot));
        const SceneView<double> exact(built.scene);
        const SceneView<float> view(built.scene);
        const std::vector<double> chances = binChances(exact, size);
        EXPECT_NEAR(std::accumulate(chances.begin(), chances.end(), 0.0), 1, 1e-5) << size.x;
        const auto run = [&](const glm::dvec4& bends) {
            CellTest cells(chances, significance());
            test::IndependentNumbers numbers(81);
            for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
                const glm::dvec3 direction(sampleEnvironment(view, numbers.words(bends)).direction);
                const auto place = environmentPlace(exact, direction);
                cells.add(binOf(size, place.column, place.row));
            }
            return cells;
        };
        test::expectFitUnlessBent(fmt::format("cells of {}{}", size.x, isHot ? ", one of them hot" : ""), {0, 1}, 0.03,
                                  run);
    }
}

/// Words that choose the same cell, but another place in it.
glm::uvec3 bentWithinCell(const CompiledScene& scene, const glm::uvec3& words, const glm::dvec4& bends) {
    const std::span<const glm::uvec2> tables(scene.distributions);
    const shared::EnvironmentMap& map = scene.constants.environmentMap;
    const auto rows = tables.first(map.height);
    const std::size_t row = invertDistribution(rows, words.x, 0.0).entry;
    const auto cells = tables.subspan(map.height + row * (map.width + 1), map.width + 1);
    return {test::bentWithin(rows, words.x, bends.x), test::bentWithin(cells, words.y, bends.y), words.z};
}

// Uniform by solid angle also in the cells that touch a pole (H58).
TEST(EnvironmentSampling, DirectionsAreUniformWithinTheirCell) {
    for (const glm::uvec2 size : {glm::uvec2(5, 3), kSmall, kLarge}) {
        const HandScene built = mapScene(test::madeMap(size, 0, false));
        const SceneView<double> view(built.scene);
        const auto run = [&](const glm::dvec4& bends) {
            CellTest cells(36, significance());
            test::IndependentNumbers numbers(82);
            for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
                const glm::dvec3 d =
                    sampleEnvironment(view, bentWithinCell(built.scene, numbers.words(), bends)).direction;
                const auto place = environmentPlace(view, d);
                const double step = kPi<double> / (size.y - 1), upper = std::cos(step * place.row);
                const double down = (upper - d.y) / (upper - std::cos(step * (place.row + 1)));
                cells.add(partOf(down, 6) * 6 + partOf(place.fraction.x, 6));
            }
            return cells;
        };
        test::expectFitUnlessBent(fmt::format("within cells of {}", size.x), {0, 1}, 0.02, run);
    }
}

// E[1 / pdf] is the solid angle of what has a density: 4 pi.
TEST(EnvironmentSampling, MeanOfTheInverseDensityIsTheWholeSphere) {
    for (const glm::uvec2 size : {glm::uvec2(5, 3), kSmall, kLarge}) {
        const HandScene built = mapScene(test::madeMap(size, 0, false));
        const SceneView<float> view(built.scene);
        const double mean = luminance(glm::dvec3(view.lights[0].emission));
        RunningMoments moments, filtered;
        test::IndependentNumbers numbers(85);
        // The luminance of cells varies by less than itself: 2.5 million samples for 0.5 %.
        for (int i = 0; i < 2'500'000; ++i) {
            const auto sample = sampleEnvironment(view, numbers.words());
            moments.add(1 / double(sample.pdf));
            filtered.add(4 * kPi<double> * mean /
                         luminance(glm::dvec3(environmentAt(view, sample.direction).radiance)));
        }
        test::expectResolvedMean(moments, 4 * kPi<double>, significance(), fmt::format("solid angle of {}", size.x));
        EXPECT_FALSE(test::agrees(filtered, 4 * kPi<double>, significance())) << "density of the filtered texel";
    }
}

/// Largest ratio of filtered luminance to density, in units of the integral of the luminance; half of the directions
/// are within two texels of the brightest.
double largestWeight(const EmitterDescription& map, const SceneView<double>& view) {
    test::IndependentNumbers numbers(83);
    double largest = 0;
    const glm::dvec2 size(map.map.size), hot(map.map.size / 3u);
    for (int i = 0; i < 200'000; ++i) {
        const double x = numbers.uniform<double>(), y = numbers.uniform<double>();
        const double u = i % 2 ? x : (hot.x + 0.5 + 4 * (x - 0.5)) / size.x;
        const double v = i % 2 ? y : (hot.y + 4 * (y - 0.5)) / (size.y - 1);
        const double turn = 2 * kPi<double> * u, angle = kPi<double> * v;
        const glm::dvec3 d(std::sin(turn) * std::sin(angle), std::cos(angle), -std::cos(turn) * std::sin(angle));
        const auto light = environmentAt(view, d);
        EXPECT_TRUE(light.pdf > 0 || light.radiance == glm::dvec3(0));
        largest = std::max(largest, luminance(light.radiance) / light.pdf);
    }
    return largest / (4 * kPi<double> * luminance(glm::dvec3(view.lights[0].emission)));
}

// A cell's density is proportional to the root mean square r of the bilinear interpolant of its corners' luminances.
// The interpolant is at most 3 r, as r is least for a given largest corner when the others are black. And r, a norm, is
// at most 4 / 3 of the mean, also for one bright corner (1 / 3 and 1 / 4 of it), so that the sum over the cells that
// divides the densities is at most 4 / 3 of the integral: together 4, of which a single bright texel takes all.
TEST(EnvironmentSampling, NoDirectionIsMoreThanFourTimesBrighterThanItsDensity) {
    for (const glm::uvec2 size : {kSmall, kLarge})
        for (const bool isHot : {true, false}) {
            const EmitterDescription map = test::madeMap(size, 0, isHot);
            const HandScene built = mapScene(map);
            const double largest = largestWeight(map, SceneView<double>(built.scene));
            EXPECT_LE(largest, 4.0) << size.x;
            // Of the small map the hot texel has 0.997 of the light, and one of the directions is within 0.05 of it.
            if (isHot && size == kSmall) {
                EXPECT_GT(largest, 3.8);
            }
        }
}

/// Black but for one texel of 1e6.
EmitterDescription oneTexel(glm::uvec2 size, glm::uvec2 place) {
    EmitterDescription map = test::madeMap(size);
    for (glm::vec3& texel : map.map.texels) texel = glm::vec3(0);
    map.map.texels[place.y * size.x + place.x] = glm::vec3(1e6f);
    return map;
}

/// Irradiance on a floor facing `up` from the four cells around a texel, by quadrature.
double irradiance(const EmitterDescription& map, glm::uvec2 place, const glm::dvec3& up) {
    constexpr int kPoints = 200;
    const glm::dvec2 size(map.map.size);
    double sum = 0;
    for (int j = 0; j < 2 * kPoints; ++j)
        for (int i = 0; i < 2 * kPoints; ++i) {
            const double u = (place.x - 0.5 + (i + 0.5) / kPoints) / size.x;
            const double v = (place.y - 1.0 + (j + 0.5) / kPoints) / (size.y - 1);
            const double turn = 2 * kPi<double> * u, angle = kPi<double> * v;
            const glm::dvec3 d(std::sin(turn) * std::sin(angle), std::cos(angle), -std::cos(turn) * std::sin(angle));
            sum += std::max(0.0, glm::dot(d, up)) * test::mapRadiance(map, u, v).x * std::sin(angle);
        }
    return sum * 2 * kPi<double> * kPi<double> / (size.x * (size.y - 1) * kPoints * kPoints);
}

/// Irradiance by the sampler alone: cheap enough for what a render cannot resolve.
RunningMoments sampledIrradiance(const EmitterDescription& map, const glm::vec3& up) {
    const HandScene built = mapScene(map);
    const SceneView<float> view(built.scene);
    test::IndependentNumbers numbers(84);
    RunningMoments moments;
    for (int i = 0; i < 6'000'000; ++i) {
        const auto sample = sampleEnvironment(view, numbers.words());
        const float cosine = std::max(0.0f, glm::dot(sample.direction, up));
        moments.add(double(environmentAt(view, sample.direction).radiance.x * cosine / sample.pdf));
    }
    return moments;
}

test::PixelEstimate floorUnder(const EmitterDescription& map, bool isSampled, std::uint64_t samples) {
    HandScene built = test::floorPatch();
    built.setEnvironmentMap(map, isSampled);
    return test::renderPixel(built.scene, samples);
}

TEST(EnvironmentLight, OneHotTexelLightsAFloorByItsSolidAngle) {
    for (const glm::uvec2 size : {kSmall, kLarge}) {
        const glm::uvec2 place = size * glm::uvec2(9, 13) / glm::uvec2(16, 32);  // towards +z
        const EmitterDescription map = oneTexel(size, place);
        const double exact = irradiance(map, place, {0, 0, 1});
        const double angle = kPi<double> * place.y / (size.y - 1), turn = 2 * kPi<double> * (place.x + 0.5) / size.x;
        const double coarse = 1e6 * 2 * kPi<double> / size.x * kPi<double> / (size.y - 1) * std::sin(angle) *
                              (-std::cos(turn) * std::sin(angle));
        EXPECT_NEAR(coarse / exact, 1, size.x == 64 ? 0.01 : 0.001);
        const RunningMoments sampled = sampledIrradiance(map, {0, 0, 1});
        test::expectMean(sampled, exact, significance(), fmt::format("irradiance by {}", size.x));
        // In each of the four cells E[f^2] / E[f]^2 is (1/3)^2 / (1/4)^2: a variation of 0.88.
        EXPECT_LT(sampled.standardError(), 0.9 * exact / std::sqrt(double(sampled.count())));
        const test::PixelEstimate found = floorUnder(map, true, 1'000'000);
        const double expected = 0.5 / kPi<double> * exact;
        EXPECT_LT(found.error, 0.001 * expected);
        EXPECT_NEAR(found.mean, expected, twoSidedThreshold(significance()) * found.error) << size.x;
    }
}

TEST(EnvironmentLight, CompensationAndScatteringAloneLeaveTheMean) {
    EmitterDescription plain = test::madeMap({32, 16}, 140, false), compensated = plain;
    for (std::size_t i = 100; i < 110; ++i) plain.map.texels[i] *= 40.0f;
    compensated.map = plain.map;
    compensated.misCompensation = true;
    const test::PixelEstimate a = floorUnder(plain, true, 1'000'000), b = floorUnder(compensated, true, 1'000'000),
                              c = floorUnder(plain, false, 2'000'000);
    const auto expectEqual = [&](const test::PixelEstimate& x, const test::PixelEstimate& y, const char* what) {
        EXPECT_LT(std::abs(x.mean - y.mean) / std::hypot(x.error, y.error), twoSidedThreshold(significance()))
            << what << ": " << x.mean << " +- " << x.error << ", " << y.mean << " +- " << y.error;
    };
    expectEqual(a, b, "compensated");
    expectEqual(a, c, "scattering alone");
    std::printf("variance: plain 1, compensated %.3f\n", std::pow(b.error / a.error, 2.0));
}

TEST(EnvironmentLight, ScatteringAloneAgreesInFog) {
    const auto fog = [](bool isSampled) {
        HandScene built = test::fogBox();
        EmitterDescription map = test::madeMap({32, 16}, 140, false);
        for (std::size_t i = 100; i < 110; ++i) map.map.texels[i] *= 20.0f;
        built.setEnvironmentMap(map, isSampled);
        return test::renderPixel(built.scene, 400'000);
    };
    const test::PixelEstimate both = fog(true), alone = fog(false);
    EXPECT_LT(std::abs(both.mean - alone.mean) / std::hypot(both.error, alone.error), twoSidedThreshold(significance()))
        << both.mean << " +- " << both.error << ", " << alone.mean << " +- " << alone.error;
}

}  // namespace
}  // namespace parhelion::reference
