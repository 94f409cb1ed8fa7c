#include "compile/compile_environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "compile/distribution_table.h"
#include "compile/luminance.h"

namespace parhelion {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::uint32_t kLeastWords = 8;  ///< of the 2^32 that choose, for what has a density at all

/// Mitsuba's: at least three rows, or two where they are equal anyway.
std::uint32_t paddedHeight(std::uint32_t height) { return height < 3 ? height + 1 : height; }

/// The scaled map, padded; w is left for densities.
std::vector<glm::vec4> scaledTexels(const EmitterDescription& emitter, const glm::uvec2& size) {
    const Bitmap& map = emitter.map;
    std::vector<glm::vec4> texels;
    texels.reserve(std::size_t(size.x) * size.y);
    for (std::uint32_t y = 0; y < size.y; ++y)
        for (std::uint32_t x = 0; x < size.x; ++x) {
            const std::uint32_t row = std::min(y, map.size.y - 1);
            const glm::vec3 value(glm::dvec3(map.at(x, row)) * emitter.value);
            if (!std::isfinite(value.x + value.y + value.z))
                throw InputError(emitter.where,
                                 fmt::format("environment map: \"scale\" times the texel at column {}, row {} must be "
                                             "below 3.4e38",
                                             x, row));
            texels.emplace_back(value, 0.0f);
        }
    return texels;
}

/// A row of cells: between two rows of texels.
struct RowOfCells {
    double nearEdge;              ///< 1 - cos of the angle between the nearer pole and the edge nearer to it
    double height;                ///< how much cos changes over the row
    double upperPart, lowerPart;  ///< of the height, weighted as interpolation weighs the two rows of texels
};

RowOfCells rowOfCells(std::uint32_t row, std::uint32_t rows) {
    const double step = kPi / rows, upper = step * row, lower = step * (row + 1);
    const double edge = 2 * row < rows ? upper : kPi - lower;
    RowOfCells cells;
    cells.nearEdge = 2.0 * std::pow(std::sin(0.5 * edge), 2.0);
    cells.height = 2.0 * std::sin(0.5 * (upper + lower)) * std::sin(0.5 * step);
    cells.lowerPart = 2.0 * std::cos(0.5 * (upper + lower)) * std::sin(0.5 * step) / step - std::cos(lower);
    cells.upperPart = cells.height - cells.lowerPart;
    return cells;
}

/// Root mean square over a cell of the bilinear interpolant of its corners.
double rootMeanSquare(double a, double b, double c, double d) {
    const double squares = a * a + b * b + c * c + d * d, edges = a * b + c * d + a * c + b * d;
    return std::sqrt((squares + edges + 0.5 * (a * d + b * c)) / 9.0);
}

/// Weights per steradian of the cells, row by row.
std::vector<double> cellWeights(std::span<const glm::vec4> texels, const glm::uvec2& size) {
    std::vector<double> luminances, weights;
    luminances.reserve(texels.size());
    for (const glm::vec4& texel : texels) luminances.push_back(luminance(glm::dvec3(texel)));
    weights.reserve(texels.size());
    for (std::uint32_t y = 0; y + 1 < size.y; ++y) {
        const double* upper = &luminances[std::size_t(y) * size.x];
        const double* lower = upper + size.x;
        for (std::uint32_t x = 0; x < size.x; ++x) {
            const std::uint32_t next = x + 1 == size.x ? 0 : x + 1;
            weights.push_back(rootMeanSquare(upper[x], upper[next], lower[x], lower[next]));
        }
    }
    return weights;
}

double sumOf(std::span<const double> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Takes the mean from the weights, unless that leaves none.
void compensateForScattering(std::span<const RowOfCells> rows, std::uint32_t width, std::vector<double>& weights) {
    double mean = 0.0;
    for (std::size_t y = 0; y < rows.size(); ++y)
        mean += 0.5 * rows[y].height / width * sumOf(std::span(weights).subspan(y * width, width));
    if (std::ranges::all_of(weights, [&](double weight) { return weight <= mean; })) return;
    for (double& weight : weights) weight = std::max(weight - mean, 0.0);
}

/// Table of what does not vanish in proportion to its weight; of all evenly when everything vanishes.
/// @return the probabilities, 0 for everything in the latter case.
std::vector<double> appendTable(std::span<const double> weights, CompiledScene& scene) {
    const bool vanishes = std::ranges::all_of(weights, [](double weight) { return weight == 0.0; });
    const std::vector<double> even(weights.size(), 1.0);
    DistributionTable table = buildDistribution(vanishes ? even : weights, kLeastWords);
    scene.distributions.insert(scene.distributions.end(), table.texels.begin(), table.texels.end());
    return vanishes ? std::vector<double>(weights.size(), 0.0) : std::move(table.probabilities);
}

/// Tables, and densities in the texels.
void writeSampling(std::span<const RowOfCells> rows, std::uint32_t width, std::span<const double> weights,
                   CompiledScene& scene) {
    scene.constants.environmentMap.distribution = std::uint32_t(scene.distributions.size());
    std::vector<double> rowWeights;
    for (std::size_t y = 0; y < rows.size(); ++y)
        rowWeights.push_back(rows[y].height * sumOf(weights.subspan(y * width, width)));
    const std::vector<double> rowShares = appendTable(rowWeights, scene);
    for (std::size_t y = 0; y < rows.size(); ++y) {
        const std::vector<double> shares = appendTable(weights.subspan(y * width, width), scene);
        const double perSteradian = rowShares[y] * width / (2.0 * kPi * rows[y].height);
        for (std::size_t x = 0; x < width; ++x)
            scene.environmentTexels[y * width + x].w = float(perSteradian * shares[x]);
        scene.environmentRows.emplace_back(float(rows[y].nearEdge), float(rows[y].height));
    }
}

glm::dvec3 meanRadiance(std::span<const RowOfCells> rows, std::uint32_t width, std::span<const glm::vec4> texels) {
    glm::dvec3 mean(0.0);
    for (std::size_t y = 0; y <= rows.size(); ++y) {
        const double part = (y > 0 ? rows[y - 1].lowerPart : 0.0) + (y < rows.size() ? rows[y].upperPart : 0.0);
        glm::dvec3 sum(0.0);
        for (const glm::vec4& texel : texels.subspan(y * width, width)) sum += glm::dvec3(texel);
        mean += 0.5 * part / width * sum;
    }
    return mean;
}

}  // namespace

bool isUniform(const Bitmap& map) {
    return std::ranges::all_of(map.texels, [&](const glm::vec3& texel) { return texel == map.texels.front(); });
}

glm::dvec3 compileEnvironment(const EmitterDescription& emitter, bool compensate, CompiledScene& scene) {
    const glm::uvec2 size{emitter.map.size.x, paddedHeight(emitter.map.size.y)};
    if (std::uint64_t(size.x) * size.y > kMaxTexels)
        throw InputError(emitter.where, fmt::format("an environment map must have at most {} texels; got {} x {}",
                                                    kMaxTexels, size.x, emitter.map.size.y));
    const std::uint64_t tables = size.y + std::uint64_t(size.x + 1) * (size.y - 1);
    if (scene.distributions.size() + tables > kMaxTexels)
        throw InputError(emitter.where,
                         fmt::format("the tables that choose from lights, phase functions and the environment map must "
                                     "have at most {} entries in all; got {}",
                                     kMaxTexels, scene.distributions.size() + tables));
    std::vector<glm::vec4> texels = scaledTexels(emitter, size);
    if (std::ranges::all_of(texels, [](const glm::vec4& texel) { return texel == glm::vec4(0.0f); }))
        return glm::dvec3(0.0);

    std::vector<RowOfCells> rows;
    for (std::uint32_t y = 0; y + 1 < size.y; ++y) rows.push_back(rowOfCells(y, size.y - 1));
    std::vector<double> weights = cellWeights(texels, size);
    if (compensate) compensateForScattering(rows, size.x, weights);
    shared::EnvironmentMap& map = scene.constants.environmentMap;
    map.localX = glm::vec3(glm::normalize(glm::dvec3(emitter.toWorld[0])));
    map.localY = glm::vec3(glm::normalize(glm::dvec3(emitter.toWorld[1])));
    map.localZ = glm::vec3(glm::normalize(glm::dvec3(emitter.toWorld[2])));
    map.width = size.x;
    map.height = size.y;
    scene.environmentTexels = std::move(texels);
    writeSampling(rows, size.x, weights, scene);
    return meanRadiance(rows, size.x, scene.environmentTexels);
}

}  // namespace parhelion
