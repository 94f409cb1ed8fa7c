// make_cloud FILE [N]: writes the cumulus of scenes/cloud_box.xml, in the volume format of FILE's extension; with N,
// the means over blocks of N^3 voxels. scenes/cumulus_coarse.vol has N = 2.
//
// A cumulus is a heap of turrets over a flat base, each turret covered with smaller ones. The cloud is the
// union of such spheres, its surface pushed out by cellular noise (Worley 1996) into round billows; the
// density rises across a thin shell, as water content does at a cloud's edge. The same file every time:
// integer hashes, no random state.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <glm/glm.hpp>
#include <vector>

#include "volume/volume_file.h"

namespace {

using glm::dvec3;

// Lengths are in half widths of the grid: x and z span [-1, 1], y spans [-5/6, 5/6].
constexpr glm::uvec3 kResolution{96, 80, 96};
constexpr double kVoxel = 2.0 / 96;
constexpr double kBase = -0.56;          // height of the flat base
constexpr double kShell = 2.4 * kVoxel;  // depth over which the density rises from 0 to 1

struct Turret {
    dvec3 center;
    double radius;
};

/// PCG hash of Jarzynski and Olano 2020, one word.
std::uint32_t hash(std::uint32_t value) {
    value = value * 747796405u + 2891336453u;
    value = ((value >> ((value >> 28) + 4)) ^ value) * 277803737u;
    return (value >> 22) ^ value;
}

/// Three numbers in [0, 1) from a lattice point.
dvec3 hashToUnit(glm::ivec3 cell, std::uint32_t seed) {
    const std::uint32_t x =
        hash(std::uint32_t(cell.x) + hash(std::uint32_t(cell.y) + hash(std::uint32_t(cell.z) + seed)));
    const std::uint32_t y = hash(x), z = hash(y);
    return dvec3(x, y, z) * 0x1p-32;
}

/// Cellular noise: 1 at the feature points, one a unit cell, falling to 0 at distance 1.
double billow(dvec3 p, std::uint32_t seed) {
    const glm::ivec3 home{glm::floor(p)};
    double nearest = 1.0;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const glm::ivec3 cell = home + glm::ivec3(x, y, z);
                nearest = std::min(nearest, glm::distance(p, dvec3(cell) + hashToUnit(cell, seed)));
            }
    return std::sqrt(1.0 - nearest * nearest);
}

/// Value noise in [0, 1] with a smooth fade, one value a unit cell.
double valueNoise(dvec3 p, std::uint32_t seed) {
    const dvec3 cell = glm::floor(p);
    const dvec3 f = p - cell, fade = f * f * (3.0 - 2.0 * f);
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step{corner & 1, corner >> 1 & 1, corner >> 2};
        const dvec3 weight = glm::mix(1.0 - fade, fade, dvec3(step));
        sum += weight.x * weight.y * weight.z * hashToUnit(glm::ivec3(cell) + step, seed).x;
    }
    return sum;
}

/// Sum of octaves of value noise, normalised to [0, 1].
double fractalNoise(dvec3 p, int octaves, std::uint32_t seed) {
    double sum = 0, weight = 0.5, total = 0;
    for (int octave = 0; octave < octaves; ++octave, p *= 2.03, weight *= 0.5) {
        sum += weight * valueNoise(p, seed + std::uint32_t(octave));
        total += weight;
    }
    return sum / total;
}

/// Turrets on the upper side of `parent`, each about half its size.
void growTurrets(const Turret& parent, int count, std::uint32_t seed, std::vector<Turret>& turrets) {
    for (int i = 0, tried = 0; i < count; ++tried) {
        const dvec3 direction = 2.0 * hashToUnit({i, tried, 7}, seed) - 1.0;
        const double length = glm::length(direction);
        if (length > 1.0 || length < 0.1 || direction.y < -0.15 * length) continue;
        const double size = parent.radius * (0.36 + 0.2 * hashToUnit({i, tried, 8}, seed).x);
        turrets.push_back({parent.center + direction * (0.86 * parent.radius / length), size});
        ++i;
    }
}

std::vector<Turret> buildTurrets() {
    const std::vector<Turret> heap{
        {{-0.04, 0.04, 0.00}, 0.44},  {{-0.46, -0.24, 0.06}, 0.34},  {{0.44, -0.20, -0.04}, 0.36},
        {{0.08, -0.28, 0.46}, 0.34},  {{-0.08, -0.26, -0.46}, 0.32}, {{0.16, 0.36, -0.06}, 0.27},
        {{-0.72, -0.38, 0.14}, 0.19}, {{0.74, -0.36, 0.12}, 0.19},   {{-0.26, 0.28, 0.16}, 0.25},
        {{0.34, 0.06, 0.30}, 0.24},   {{-0.30, -0.22, 0.46}, 0.26}};
    std::vector<Turret> turrets = heap;
    for (std::size_t i = 0; i < heap.size(); ++i) growTurrets(heap[i], 11, hash(std::uint32_t(i) + 41), turrets);
    return turrets;
}

/// Signed distance to the heap, negative inside; neighbours blend over `blend` so that creases stay soft.
double distanceToHeap(dvec3 p, const std::vector<Turret>& turrets) {
    constexpr double kBlend = 0.045;
    double nearest = 10.0;
    for (const Turret& turret : turrets) {
        const double d = glm::distance(p, turret.center) - turret.radius;
        const double h = std::max(kBlend - std::abs(nearest - d), 0.0) / kBlend;
        nearest = std::min(nearest, d) - 0.25 * h * h * kBlend;
    }
    return nearest;
}

double densityAt(dvec3 p, const std::vector<Turret>& turrets) {
    const dvec3 warp =
        dvec3(fractalNoise(3.0 * p, 3, 11), fractalNoise(3.0 * p, 3, 23), fractalNoise(3.0 * p, 3, 37)) - 0.5;
    const dvec3 q = p + 0.10 * warp;
    const double bulge = 0.13 * (billow(5.5 * q, 101) - 0.6) + 0.055 * (billow(12.0 * q, 211) - 0.6);
    const double heap = distanceToHeap(q, turrets) - bulge;
    const double base = kBase + 0.09 * (fractalNoise(4.0 * p, 3, 53) - 0.5) - p.y;
    const double depth = -std::max(heap, 0.8 * base) / kShell;
    const double edge = glm::smoothstep(0.0, 1.0, depth);
    return edge * (0.72 + 0.28 * fractalNoise(5.0 * p, 3, 71));
}

/// Densities below half a step of a byte are empty, so that bricks of nothing else take no room.
parhelion::DensityGrid buildCumulus() {
    const std::vector<Turret> turrets = buildTurrets();
    parhelion::DensityGrid grid(kResolution);
    for (unsigned z = 0; z < kResolution.z; ++z)
        for (unsigned y = 0; y < kResolution.y; ++y)
            for (unsigned x = 0; x < kResolution.x; ++x) {
                const dvec3 center = (dvec3(x, y, z) + 0.5 - 0.5 * dvec3(kResolution)) * kVoxel;
                const double density = densityAt(center, turrets);
                if (density >= 0.5 / 255) grid.set({x, y, z}, float(density));
            }
    return grid;
}

/// Means over blocks of n^3 voxels; n divides the resolution.
parhelion::DensityGrid coarsen(const parhelion::DensityGrid& fine, unsigned n) {
    parhelion::DensityGrid grid(fine.resolution() / n);
    const glm::uvec3 size = grid.resolution();
    for (unsigned i = 0; i < size.x * size.y * size.z; ++i) {
        const glm::uvec3 voxel{i % size.x, i / size.x % size.y, i / (size.x * size.y)};
        double sum = 0;
        for (unsigned k = 0; k < n * n * n; ++k)
            sum += double(fine.at(n * voxel + glm::uvec3(k % n, k / n % n, k / (n * n))));
        if (sum > 0) grid.set(voxel, float(sum / (n * n * n)));
    }
    return grid;
}

}  // namespace

int main(int count, char** arguments) try {
    const unsigned block = count == 3 ? unsigned(std::atoi(arguments[2])) : 1;
    if (count < 2 || count > 3 || block == 0 || glm::any(glm::notEqual(kResolution % block, glm::uvec3(0)))) {
        std::fputs("usage: make_cloud FILE.grid|.vol|.vdb|.nvdb [1|2|4|8|16]\n", stderr);
        return 2;
    }
    parhelion::Volume volume;
    volume.density = coarsen(buildCumulus(), block);
    const std::filesystem::path file = arguments[1];
    using parhelion::GridValueType;
    parhelion::writeVolume(file, volume,
                           {file.extension() == ".grid" ? GridValueType::kUnorm8 : GridValueType::kFloat32});
    return 0;
} catch (const parhelion::InputError& error) {
    std::fprintf(stderr, "make_cloud: %s\n", error.what());
    return 2;
} catch (const std::exception& error) {
    std::fprintf(stderr, "make_cloud: %s\n", error.what());
    return 3;
}
