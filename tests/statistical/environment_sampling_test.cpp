#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "compile/luminance.h"
#include "reference/light/environment.h"
#include "support/environment_maps.h"
#include "support/goodness.h"
#include "support/hand_scene.h"

// Sampled directions of environment maps against the laws they must follow, and light sampling against scattering
// alone.
namespace parhelion::reference {
namespace {

using test::CellTest;
using test::HandScene;
using test::partOf;

double significance() { return sidak(test::kFamilySignificance, 24); }

HandScene mapScene(const EmitterDescription& map) {
    HandScene scene;
    scene.setEnvironmentMap(map);
    return scene;
}

/// A uniform word whose density is bent by `bend`: a seeded defect.
std::uint32_t bent(std::uint32_t word, double bend) {
    const double u = word * 0x1p-32;
    return std::uint32_t((u + bend * u * (1 - u)) * 0x1p32);
}

glm::uvec4 nextWords(test::IndependentNumbers& numbers) {
    glm::uvec4 words;
    for (int i = 0; i < 4; ++i) words[i] = numbers.word();
    return words;
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

// A sun of 1e6 in one texel (H44, H57), at both ends of the sizes of maps.
TEST(EnvironmentSampling, CellsAreFoundAsTheirDensitySays) {
    for (const glm::uvec2 size : {glm::uvec2(64, 32), glm::uvec2(4096, 2048)}) {
        const HandScene built = mapScene(test::madeMap(size));
        const SceneView<double> exact(built.scene);
        const SceneView<float> view(built.scene);
        const std::vector<double> chances = binChances(exact, size);
        EXPECT_NEAR(std::accumulate(chances.begin(), chances.end(), 0.0), 1, 1e-5) << size.x;
        const auto run = [&](double bendRow, double bendColumn) {
            CellTest cells(chances, significance());
            test::IndependentNumbers numbers(81);
            for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
                glm::uvec4 words = nextWords(numbers);
                words.x = bent(words.x, bendRow);
                words.y = bent(words.y, bendColumn);
                const auto place = environmentPlace(exact, glm::dvec3(sampleEnvironment(view, words).direction));
                cells.add(binOf(size, place.column, place.row));
            }
            return cells;
        };
        run(0, 0).expectFit("cells of " + std::to_string(size.x));
        if (size.x > 64) continue;
        run(0.02, 0).expectMisfit("rows bent by 2 %");
        run(0, 0.02).expectMisfit("columns bent by 2 %");
    }
}

// Uniform by solid angle also in the cells that touch a pole (H58).
TEST(EnvironmentSampling, DirectionsAreUniformWithinTheirCell) {
    for (const glm::uvec2 size : {glm::uvec2(5, 3), glm::uvec2(64, 32)}) {
        const HandScene built = mapScene(test::madeMap(size, 0, false));
        const SceneView<double> view(built.scene);
        const auto run = [&](double bendHeight, double bendTurn) {
            CellTest cells(36, significance());
            test::IndependentNumbers numbers(82);
            for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
                glm::uvec4 words = nextWords(numbers);
                words.z = bent(words.z, bendHeight);
                words.w = bent(words.w, bendTurn);
                const glm::dvec3 d = sampleEnvironment(view, words).direction;
                const auto place = environmentPlace(view, d);
                const double step = kPi<double> / (size.y - 1), upper = std::cos(step * place.row);
                const double down = (upper - d.y) / (upper - std::cos(step * (place.row + 1)));
                const double fromPole = 2 * place.row + 1 < size.y ? down : 1 - down;
                cells.add(partOf(fromPole, 6) * 6 + partOf(place.fraction.x, 6));
            }
            return cells;
        };
        run(0, 0).expectFit("within cells");
        run(0.02, 0).expectMisfit("heights bent by 2 %");
        run(0, 0.02).expectMisfit("azimuths bent by 2 %");
    }
}

/// Largest ratio of filtered luminance to density, in units of the integral of the luminance.
double largestWeight(const EmitterDescription& map, const SceneView<double>& view) {
    test::IndependentNumbers numbers(83);
    double largest = 0;
    const glm::dvec2 hot = (glm::dvec2(map.map.size / 3u) + glm::dvec2(0.5, 0)) / glm::dvec2(map.map.size);
    for (int i = 0; i < 200'000; ++i) {
        const double u = i % 2 ? numbers.uniform<double>() : hot.x + (numbers.uniform<double>() - 0.5) / 16;
        const double v = i % 2 ? numbers.uniform<double>() : hot.y + (numbers.uniform<double>() - 0.5) / 8;
        const double turn = 2 * kPi<double> * u, angle = kPi<double> * v;
        const glm::dvec3 d(std::sin(turn) * std::sin(angle), std::cos(angle), -std::cos(turn) * std::sin(angle));
        const auto light = environmentAt(view, d);
        EXPECT_TRUE(light.pdf > 0 || light.radiance == glm::dvec3(0));
        largest = std::max(largest, luminance(light.radiance) / light.pdf);
    }
    return largest / (4 * kPi<double> * luminance(glm::dvec3(view.lights[0].emission)));
}

TEST(EnvironmentSampling, NoDirectionIsMoreThanThreeTimesBrighterThanItsDensity) {
    for (const bool isHot : {true, false}) {
        const EmitterDescription map = test::madeMap({64, 32}, 0, isHot);
        const HandScene built = mapScene(map);
        // A third of the largest value is the least a root mean square can be; its mean exceeds that of the values by a
        // factor of at most sqrt(4 / 9) / (1 / 4) = 8 / 3 ... of one hot texel, 4 / 3.
        EXPECT_LT(largestWeight(map, SceneView<double>(built.scene)), 3.0 * 4 / 3 + 0.1);
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
    for (int i = 0; i < 12'000'000; ++i) {
        const auto sample = sampleEnvironment(view, nextWords(numbers));
        const float cosine = std::max(0.0f, glm::dot(sample.direction, up));
        moments.add(double(environmentAt(view, sample.direction).radiance.x * cosine / sample.pdf));
    }
    return moments;
}

test::PixelEstimate floorUnder(const EmitterDescription& map, bool isSampled, std::uint64_t samples) {
    HandScene built;
    built.lookAlong({0, 0, -1});
    built.addQuad({-0.1f, -0.1f, -1}, {0.2f, 0, 0}, {0, 0.2f, 0}, built.addDiffuse(glm::vec3(0.5f)));
    built.setEnvironmentMap(map, isSampled);
    return test::renderPixel(built.scene, samples);
}

TEST(EnvironmentLight, OneHotTexelLightsAFloorByItsSolidAngle) {
    for (const glm::uvec2 size : {glm::uvec2(64, 32), glm::uvec2(4096, 2048)}) {
        const glm::uvec2 place = size * glm::uvec2(9, 13) / glm::uvec2(16, 32);  // towards +z
        const EmitterDescription map = oneTexel(size, place);
        const double exact = irradiance(map, place, {0, 0, 1});
        const double angle = kPi<double> * place.y / (size.y - 1), turn = 2 * kPi<double> * (place.x + 0.5) / size.x;
        const double coarse = 1e6 * 2 * kPi<double> / size.x * kPi<double> / (size.y - 1) * std::sin(angle) *
                              (-std::cos(turn) * std::sin(angle));
        EXPECT_NEAR(coarse / exact, 1, size.x == 64 ? 0.01 : 0.001);
        const RunningMoments sampled = sampledIrradiance(map, {0, 0, 1});
        EXPECT_NEAR(sampled.mean() / exact, 1, 1e-3);  // 4 standard errors
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
        HandScene built;
        built.lookAlong({0.1f, 0.2f, -1});
        built.addBox({-2, -2, -4}, {2, 2, -2}, built.addNull(built.addHomogeneous(1, {0.9f, 0.8f, 0.7f}, 0.6f)));
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
