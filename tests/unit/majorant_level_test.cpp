#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "compile/majorant_grid.h"

namespace parhelion {
namespace {

constexpr glm::uvec3 kResolution(64);

/// A field of bumps: `peak` in the middle of every fourth 16^3 block, falling off to zero, over `floor`.
DensityGrid bumps(float peak, float floor) {
    std::vector<float> values;
    for (unsigned z = 0; z < 64; ++z)
        for (unsigned y = 0; y < 64; ++y)
            for (unsigned x = 0; x < 64; ++x) {
                const bool bump = (x / 16 + y / 16 + z / 16) % 4 == 0;
                const glm::vec3 d = glm::vec3(x % 16, y % 16, z % 16) - 7.5f;
                values.push_back(floor + (bump ? peak * std::max(0.0f, 1 - glm::length(d) / 8) : 0.0f));
            }
    return DensityGrid::fromDense(kResolution, values);
}

/// Mean steps of delta tracking, played out: rays from uniform points and from as many drawn by density.
double playedSteps(const DensityGrid& density, const MajorantGrid& majorants, double depth) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto point = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)) * 64.0; };
    const float largest = density.maximum();
    double steps = 0;
    constexpr int kRays = 4'000;
    for (int ray = 0; ray < kRays; ++ray) {
        glm::dvec3 p = point();
        if (ray % 2 == 1)
            while (density.interpolate(p) < uniform(random) * largest) p = point();
        const double z = 2 * uniform(random) - 1, phi = 6.283185307179586 * uniform(random), r = std::sqrt(1 - z * z);
        const glm::dvec3 d(r * std::cos(phi), r * std::sin(phi), z);
        const double edge = majorants.cellSize();
        while (glm::all(glm::greaterThanEqual(p, glm::dvec3(0))) && glm::all(glm::lessThan(p, glm::dvec3(64)))) {
            ++steps;
            double toPlane = 1e9;
            for (int i = 0; i < 3; ++i) {
                const double plane = edge * (std::floor(p[i] / edge) + (d[i] > 0 ? 1 : 0));
                toPlane = std::min(toPlane, (plane - p[i]) / d[i]);
            }
            const double bound = majorants.at(p), free = -std::log(1 - uniform(random)) / (bound * depth);
            p += (std::min(free, toPlane + 1e-9)) * d;
            if (free < toPlane && uniform(random) * bound < density.interpolate(p)) break;
        }
    }
    return steps / kRays;
}

std::vector<MajorantGrid> levelsOf(const DensityGrid& density) {
    std::vector<MajorantGrid> levels{buildMajorants(density)};
    while (levels.back().bounds.size() > 1) levels.push_back(coarsen(levels.back()));
    return levels;
}

/// The estimate has 512 rays and the play 4000, each to a few percent: 10 % covers both.
TEST(MajorantLevel, TakesFewestStepsWhenPlayedOut) {
    for (const float floor : {0.0f, 0.05f})
        for (const double depth : {1e-3, 0.03, 0.3, 3.0}) {
            const DensityGrid density = bumps(1.0f, floor);
            double least = 1e9;
            for (const MajorantGrid& level : levelsOf(density))
                least = std::min(least, playedSteps(density, level, depth));
            const MajorantGrid chosen = chooseMajorants(density, glm::dvec3(depth));
            EXPECT_LE(playedSteps(density, chosen, depth), 1.1 * least) << "floor " << floor << ", depth " << depth;
        }
}

TEST(MajorantLevel, FollowsTheDepth) {
    const DensityGrid density = bumps(1.0f, 0.0f);
    EXPECT_EQ(chooseMajorants(density, glm::dvec3(1e-4)).bounds.size(), 1u);
    unsigned coarser = chooseMajorants(density, glm::dvec3(1e-3)).level;
    EXPECT_GT(coarser, chooseMajorants(density, glm::dvec3(1.0)).level);
    for (double depth = 2e-3; depth < 1.0; depth *= 2) {
        const unsigned level = chooseMajorants(density, glm::dvec3(depth)).level;
        EXPECT_LE(level, coarser) << depth;
        coarser = level;
    }
    const DensityGrid constant = DensityGrid::fromDense(kResolution, std::vector<float>(64 * 64 * 64, 1.0f));
    EXPECT_EQ(chooseMajorants(constant, glm::dvec3(10.0)).bounds.size(), 1u) << "nothing to tell cells apart";
}

}  // namespace
}  // namespace parhelion
