#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "compile/majorant_grid.h"

namespace parhelion {

namespace {

constexpr std::size_t kRays = 512;
constexpr double kStride = 2.0;      // voxels between two looks at the density
constexpr double kFaintest = 1e-3;   // transmittance at which a ray ends
constexpr int kMostStrides = 20000;  // beyond the diagonal of the largest grid

/// Point i of the additive recurrence in five dimensions whose steps are powers of the root of x^6 = x + 1.
/// Source: Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences".
std::array<double, 5> quasirandom(std::size_t i) {
    constexpr double kRoot = 1.1347241384015194;
    std::array<double, 5> u{};
    double step = 1.0;
    for (double& x : u) {
        step /= kRoot;
        x = std::fmod(0.5 + step * double(i + 1), 1.0);
    }
    return u;
}

float valueAt(const DensityGrid& density, const glm::dvec3& p) {
    return density.at(glm::min(glm::uvec3(p), density.resolution() - 1u));
}

struct Probe {
    double startDensity = 0.0;
    std::vector<double> steps;  ///< by level
};

/// Steps of one ray through each of `levels`, each weighted by the transmittance up to it.
Probe probe(const DensityGrid& density, std::span<const MajorantGrid> levels, const glm::dvec3& depthPerVoxel,
            std::size_t ray) {
    const std::array<double, 5> u = quasirandom(ray);
    const glm::dvec3 size(density.resolution());
    const double z = 2.0 * u[3] - 1.0, r = std::sqrt(1.0 - z * z), phi = 2.0 * std::numbers::pi * u[4];
    const glm::dvec3 perDepth = glm::dvec3(r * std::cos(phi), r * std::sin(phi), z) / depthPerVoxel;
    const double stride = kStride / std::max({std::abs(perDepth.x), std::abs(perDepth.y), std::abs(perDepth.z)});
    glm::dvec3 p = glm::dvec3(u[0], u[1], u[2]) * size;
    Probe result{valueAt(density, p), std::vector<double>(levels.size(), 0.0)};
    double transmittance = 1.0;
    for (int i = 0; i < kMostStrides && transmittance > kFaintest; ++i) {
        const glm::dvec3 next = p + stride * perDepth;
        const bool leaves = glm::any(glm::lessThan(next, glm::dvec3(0.0))) || glm::any(glm::greaterThan(next, size));
        for (std::size_t level = 0; level < levels.size(); ++level) {
            const double edge = levels[level].cellSize();
            const glm::dvec3 moved = glm::abs(glm::floor(next / edge) - glm::floor(p / edge));
            result.steps[level] += transmittance * (levels[level].at(p) * stride + moved.x + moved.y + moved.z);
        }
        if (leaves) break;
        transmittance *= std::exp(-double(valueAt(density, p)) * stride);
        p = next;
    }
    return result;
}

}  // namespace

MajorantGrid chooseMajorants(const DensityGrid& density, const glm::dvec3& depthPerVoxel) {
    std::vector<MajorantGrid> levels{buildMajorants(density)};
    while (levels.back().bounds.size() > 1) levels.push_back(coarsen(levels.back()));

    std::vector<Probe> probes(kRays);
    parallelFor(
        kRays, [&](std::size_t ray) { probes[ray] = probe(density, levels, depthPerVoxel, ray); }, 16);
    double mean = 0.0;
    for (const Probe& p : probes) mean += p.startDensity / double(kRays);
    std::vector<double> steps(levels.size(), 0.0);
    for (const Probe& p : probes)
        for (std::size_t level = 0; level < levels.size(); ++level)
            steps[level] += (1.0 + (mean > 0.0 ? p.startDensity / mean : 0.0)) * p.steps[level];
    return std::move(levels[std::size_t(std::ranges::min_element(steps) - steps.begin())]);
}

}  // namespace parhelion
