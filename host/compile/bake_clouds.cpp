#include "compile/bake_clouds.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>

#include "base/memory.h"
#include "base/parallel.h"

namespace parhelion {
namespace {

constexpr std::size_t kErrorPoints = 1u << 16;

std::size_t voxelCount(glm::uvec3 n) { return std::size_t(n.x) * n.y * n.z; }

double sumOf(std::span<const float> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Calls body(voxel, p) for the centre p, in the unit cube, of each voxel.
template <typename Body>
void forEachCentre(glm::uvec3 n, const Body& body) {
    parallelFor(std::size_t(n.y) * n.z, [&](std::size_t row) {
        for (unsigned x = 0; x < n.x; ++x)
            body(row * n.x + x, (glm::dvec3(x, row % n.y, row / n.y) + 0.5) / glm::dvec3(n));
    });
}

/// The interpolant of a grid at p in the unit cube.
double densityAt(const DensityGrid& grid, const glm::dvec3& p) {
    return grid.interpolate(p * glm::dvec3(grid.resolution()));
}

std::vector<float> resample(const DensityGrid& grid, glm::uvec3 resolution) {
    if (grid.resolution() == resolution) return grid.toDense();
    std::vector<float> values(voxelCount(resolution));
    forEachCentre(resolution,
                  [&](std::size_t voxel, const glm::dvec3& p) { values[voxel] = float(densityAt(grid, p)); });
    return values;
}

/// A field with the density it modulates.
struct Source {
    shared::CloudField field;
    const DensityGrid* base;  ///< null without
    float largest = 0;        ///< of base
};

/// What a source bakes into, and the factor that restored its mass.
struct Baked {
    std::vector<float> values;
    double factor = 1;
    double massRatio = 1;
};

Baked bake(const Source& source, const CloudBaker& baker) {
    std::vector<float> base;
    if (source.base) base = resample(*source.base, source.field.resolution);
    Baked baked{.values = baker.bake(source.field, base, source.largest)};
    const double mass = sumOf(base);
    if (mass > 0) {
        const auto [factor, reached] = restoreMass(baked.values, mass, source.largest);
        baked.factor = factor;
        baked.massRatio = reached / mass;
    }
    return baked;
}

/// Collects differences; each thread's own, then added up in order.
struct Differences {
    double squares = 0, largest = 0;

    void add(double difference) {
        squares += difference * difference;
        largest = std::max(largest, std::abs(difference));
    }
    void add(const Differences& other) {
        squares += other.squares;
        largest = std::max(largest, other.largest);
    }
};

void compareWithDoubled(const Source& source, const DensityGrid& grid, const CloudBaker& baker, CloudBakeError& error) {
    Source doubled = source;
    doubled.field.resolution *= 2u;
    const glm::uvec3 n = doubled.field.resolution;
    const std::vector<float> values = bake(doubled, baker).values;
    std::vector<Differences> slices(n.z);
    parallelFor(n.z, [&](std::size_t z) {
        for (std::size_t i = 0; i < std::size_t(n.x) * n.y; ++i) {
            const glm::dvec3 p = (glm::dvec3(i % n.x, i / n.x, z) + 0.5) / glm::dvec3(n);
            slices[z].add(densityAt(grid, p) - values[z * n.x * n.y + i]);
        }
    });
    Differences all;
    for (const Differences& slice : slices) all.add(slice);
    error.doubledRms = std::sqrt(all.squares / double(values.size()));
    error.doubledMaximum = all.largest;
}

void compareWithField(const Source& source, double factor, const DensityGrid& grid, const CloudBaker& baker,
                      CloudBakeError& error) {
    std::mt19937 random(1);
    const auto uniform = [&] { return double(random()) * 0x1p-32; };
    std::vector<glm::dvec3> points(kErrorPoints);
    for (glm::dvec3& p : points) p = {uniform(), uniform(), uniform()};
    std::vector<double> differences(points.size());
    parallelFor(
        points.size(),
        [&](std::size_t i) {
            const double base = source.base ? densityAt(*source.base, points[i]) : 0.0;
            double truth = baker.evaluate(source.field, points[i], base, source.largest);
            if (source.base) truth = std::min(truth * factor, double(source.largest));
            differences[i] = densityAt(grid, points[i]) - truth;
        },
        256);
    Differences all;
    for (const double difference : differences) all.add(difference);
    error.fieldRms = std::sqrt(all.squares / double(points.size()));
    error.fieldMaximum = all.largest;
    error.points = points.size();
}

void requireMemory(const GridPlacement& placement, const CloudBakeOptions& options) {
    const std::size_t limit = options.memoryLimitBytes ? options.memoryLimitBytes : physicalMemoryBytes() / 2;
    // Baked values, the grid made of them, and the density they modulate; the error takes a bake of 8 times the voxels.
    const std::size_t arrays = 2 + (placement.cloud->modulates ? 1 : 0);
    const double bytes = double(sizeof(float)) * double(voxelCount(placement.cloud->resolution)) *
                         double(arrays + (options.measureError ? 8 * (arrays - 1) : 0));
    if (bytes > double(limit))
        throw InputError(
            placement.where,
            fmt::format("baking this cloud of {} x {} x {} voxels needs {:.0f} MiB; allowed are {:.0f} MiB "
                        "(bake_resolution)",
                        placement.cloud->resolution.x, placement.cloud->resolution.y, placement.cloud->resolution.z,
                        bytes / 0x1p20, double(limit) / 0x1p20));
}

float largestAtSides(const DensityGrid& grid) {
    const glm::uvec3 n = grid.resolution();
    float largest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (const unsigned side : {0u, n[axis] - 1u})
            for (unsigned a = 0; a < n[u]; ++a)
                for (unsigned b = 0; b < n[v]; ++b) {
                    glm::uvec3 voxel;
                    voxel[axis] = side, voxel[u] = a, voxel[v] = b;
                    largest = std::max(largest, grid.at(voxel));
                }
    }
    return largest;
}

CloudBakeReport bakeCloud(GridPlacement& placement, const CloudBaker& baker, const CloudBakeOptions& options,
                          std::vector<std::string>& notes) {
    requireMemory(placement, options);
    const DensityGrid base = std::move(placement.volume.density);
    const bool modulates = placement.cloud->modulates != 0;
    const Source source{*placement.cloud, modulates ? &base : nullptr, modulates ? base.maximum() : 0.0f};
    const auto start = std::chrono::steady_clock::now();
    const Baked baked = bake(source, baker);
    DensityGrid grid = DensityGrid::fromDense(source.field.resolution, baked.values);

    CloudBakeReport report{.where = placement.where.text(), .resolution = source.field.resolution};
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report.modulates = modulates;
    report.massRatio = baked.massRatio;
    report.meanDensity = sumOf(baked.values) / double(baked.values.size());
    report.occupancy =
        double(baked.values.size() - std::size_t(std::ranges::count(baked.values, 0.0f))) / double(baked.values.size());
    if (options.measureError) {
        compareWithDoubled(source, grid, baker, report.error.emplace());
        compareWithField(source, baked.factor, grid, baker, *report.error);
    }
    if (const float side = largestAtSides(grid); side > 0.0f && !modulates)
        notes.push_back(fmt::format("{}: the cloud reaches the sides of its box (density {:.2g}) and is cut there",
                                    report.where, side));
    placement.volume.density = std::move(grid);
    placement.cloud.reset();
    return report;
}

}  // namespace

std::pair<double, double> restoreMass(std::span<float> values, double mass, float largest) {
    // Newton's method on the mass as a function of the factor: concave and piecewise linear, so that it climbs to the
    // root from below and ends after as many steps as voxels reach the largest value at different factors; few in fact.
    double factor = 1, reached = 0;
    for (int step = 0; step < 64; ++step) {
        double full = 0, free = 0;
        for (const float value : values)
            (value * factor < largest ? free : full) += value * factor < largest ? value : largest;
        reached = full + free * factor;
        if (free == 0 || mass - reached <= 1e-9 * mass) break;
        factor += (mass - reached) / free;
    }
    for (float& value : values) value = std::min(float(value * factor), largest);
    return {factor, reached};
}

std::vector<CloudBakeReport> bakeClouds(SceneDescription& description, const CloudBaker& baker,
                                        const CloudBakeOptions& options) {
    std::vector<CloudBakeReport> reports;
    for (MediumDescription& medium : description.media)
        if (medium.density && medium.density->cloud)
            reports.push_back(bakeCloud(*medium.density, baker, options, description.notes));
    return reports;
}

}  // namespace parhelion
