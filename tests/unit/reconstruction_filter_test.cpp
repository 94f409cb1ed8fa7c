#include <gtest/gtest.h>

#include <cmath>

#include "unit/compile_fixtures.h"

namespace parhelion {
namespace {

using namespace fixtures;

CompiledScene compileWith(ReconstructionFilter filter, double radius, double stddev) {
    SceneDescription description = scene();
    description.film.filter = filter;
    description.film.filterRadius = radius;
    description.film.filterStddev = stddev;
    return compileScene(description);
}

// Float entries are good to 2^-24 of their value; where the density f is small, a step of 1e-9 radii in x stays
// below 1e-9 in the cumulative, which is what is compared.
constexpr double kTolerance = 2 * 0x1p-24;

void expectAntisymmetric(const std::vector<float>& table) {
    ASSERT_GE(table.size(), 257u);
    for (int k = 0; k <= 128; ++k) EXPECT_EQ(table[128 + k], -table[128 - k]) << k;
    for (int k = 0; k < 256; ++k) EXPECT_LT(table[k], table[k + 1]) << k;
}

TEST(ReconstructionTable, IsEmptyForThePixelBoxOnly) {
    const CompiledScene pixel = compileWith(ReconstructionFilter::Box, 0.5, 0.5);
    EXPECT_TRUE(pixel.filterTable.empty());
    EXPECT_EQ(pixel.constants.camera.hasFilter, 0u);
    EXPECT_FALSE(pixel.effects.has(Effect::hasFilterTable));

    const CompiledScene wide = compileWith(ReconstructionFilter::Box, 1.5, 0.5);
    expectAntisymmetric(wide.filterTable);
    for (int k = 0; k <= 256; ++k) EXPECT_NEAR(wide.filterTable[k], 1.5 * (k / 128.0 - 1.0), 1.5 * kTolerance) << k;
    EXPECT_TRUE(wide.effects.has(Effect::hasFilterTable));
}

TEST(ReconstructionTable, InvertsTheTent) {
    for (const double radius : {1.0, 2.0, 0.3}) {
        const CompiledScene compiled = compileWith(ReconstructionFilter::Tent, radius, 0.5);
        expectAntisymmetric(compiled.filterTable);
        for (int k = 0; k <= 128; ++k) {
            const double x = compiled.filterTable[k] / radius;  // in [-1, 0]: cumulative (1 + x)^2 / 2
            EXPECT_NEAR(0.5 * (1.0 + x) * (1.0 + x), k / 256.0, kTolerance) << k;
        }
    }
}

TEST(ReconstructionTable, InvertsTheTruncatedGaussian) {
    for (const auto& [s, radius] : {std::pair(0.5, 2.0), std::pair(1.25, 5.0), std::pair(0.5, 0.75)}) {
        const CompiledScene compiled = compileWith(ReconstructionFilter::Gaussian, radius, s);
        expectAntisymmetric(compiled.filterTable);
        EXPECT_EQ(compiled.filterTable[256], float(radius));
        // integral_0^x exp(-t^2 / 2 s^2) - exp(-radius^2 / 2 s^2) dt
        const auto mass = [s = s, radius = radius](double x) {
            return s * std::sqrt(std::acos(-1.0) / 2) * std::erf(x / (s * std::sqrt(2.0))) -
                   std::exp(-0.5 * radius * radius / (s * s)) * x;
        };
        for (int k = 0; k <= 256; ++k)
            EXPECT_NEAR(0.5 + 0.5 * mass(compiled.filterTable[k]) / mass(radius), k / 256.0, kTolerance) << k;
    }
}

TEST(ReconstructionTable, HoldsTheShareInsideTheFilmsEdge) {
    const CompiledScene tent = compileWith(ReconstructionFilter::Tent, 2.0, 0.5);
    ASSERT_EQ(tent.constants.camera.filterEdges, 2u);
    ASSERT_EQ(tent.filterTable.size(), 259u);
    // The cumulative 1 - (1 - x / 2)^2 / 2 at x = 1/2 and 3/2, but linear between the 256 steps of its inverse: of an
    // interval of width 1/256 under a density of at least 1/8, the parabola leaves the chord by less than 1/256 / 8
    // / 16.
    EXPECT_NEAR(tent.filterTable[257], 1 - 0.5 * 0.75 * 0.75, 3e-5);
    EXPECT_NEAR(tent.filterTable[258], 1 - 0.5 * 0.25 * 0.25, 3e-5);

    SceneDescription description = scene();
    description.film.filter = ReconstructionFilter::Gaussian;
    description.film.filterRadius = 2.0;
    EXPECT_EQ(compileScene(description).constants.camera.filterEdges, 2u);
    description.film.samplesBorder = true;
    EXPECT_EQ(compileScene(description).constants.camera.filterEdges, 0u);
    // A filter as wide as the box is a filter all the same.
    const CompiledScene narrow = compileWith(ReconstructionFilter::Tent, 0.5, 0.5);
    EXPECT_EQ(narrow.constants.camera.hasFilter, 1u);
    EXPECT_EQ(narrow.constants.camera.filterEdges, 0u);
}

TEST(ReconstructionTable, EndsAtTheScenesCropButNotAtOneAskedFor) {
    SceneDescription description = scene();
    description.film.size = {40, 30};
    description.film.cropOffset = {10, 5};
    description.film.cropSize = {20, 10};
    const shared::Camera own = compileScene(description).constants.camera;
    EXPECT_EQ(own.filmLower, glm::uvec2(10, 5));
    EXPECT_EQ(own.filmUpper, glm::uvec2(30, 15));
    CompileOptions options;
    options.cropOffset = glm::uvec2(3, 4);
    options.cropSize = glm::uvec2(5, 6);
    const shared::Camera asked = compileScene(description, options).constants.camera;
    EXPECT_EQ(asked.filmLower, glm::uvec2(0));
    EXPECT_EQ(asked.filmUpper, glm::uvec2(40, 30));
}

TEST(ReconstructionTable, RefusesAnEmptyFilter) {
    SceneDescription description = scene();
    description.film.filterRadius = 0.0;
    EXPECT_TRUE(contains(inputErrorOf(description), "radius"));
}

}  // namespace
}  // namespace parhelion
