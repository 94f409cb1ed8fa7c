#include "analysis/pixel_trust.h"

#include <algorithm>
#include <cmath>

namespace parhelion {
namespace {

constexpr double kMostOfVariance = 0.25;  // that one sample of a regular pixel has
constexpr double kMostVov = 0.1;
constexpr double kMostShift = 0.25;  // standard errors

/// What a cell's pixels say together.
struct Cell {
    double pixels = 0, regular = 0;
    double fourth = 0, squares = 0, samples = 0;  ///< over regular pixels: moments, squared variances, samples
    double spikes = 0;                            ///< over the others: what the largest sample brings to the mean
    std::vector<double> errors;                   ///< standard errors of regular pixels that vary
};

double standardError(const JudgedPixel& pixel) {
    return std::sqrt(pixel.factor * pixel.moments.variance / pixel.moments.samples);
}

bool isSpiky(const PixelMoments& m) {
    const double deviation = m.largest - m.mean;
    return deviation * deviation > kMostOfVariance * m.variance * (m.samples - 1);
}

void add(Cell& cell, const JudgedPixel& pixel) {
    const PixelMoments& m = pixel.moments;
    ++cell.pixels;
    if (!m.isFinite || m.samples < 2) return;
    if (!(m.variance > 0)) return;
    if (isSpiky(m)) {
        cell.spikes += (m.largest - m.mean) / m.samples;
        return;
    }
    ++cell.regular;
    cell.errors.push_back(standardError(pixel));
    cell.samples += m.samples;
    cell.fourth += m.fourth;
    cell.squares += m.variance * m.variance;
}

double medianOf(std::vector<double>& values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// What a neighbourhood asks of its pixels.
struct Verdict {
    bool holds = true;
    double shift = 0;  ///< that spikes bring to the mean
};

Verdict judge(const std::vector<Cell>& cells, const std::vector<double>& medians, glm::uvec2 grid, glm::uvec2 at,
              std::uint32_t radius) {
    const glm::uvec2 from = glm::max(at, glm::uvec2(radius)) - radius, to = glm::min(at + radius + 1u, grid);
    Cell sum;
    std::vector<double> typical;
    for (std::uint32_t y = from.y; y < to.y; ++y)
        for (std::uint32_t x = from.x; x < to.x; ++x) {
            const std::size_t i = std::size_t{y} * grid.x + x;
            const Cell& cell = cells[i];
            sum.pixels += cell.pixels, sum.regular += cell.regular, sum.samples += cell.samples;
            sum.fourth += cell.fourth, sum.squares += cell.squares, sum.spikes += cell.spikes;
            if (!cell.errors.empty()) typical.push_back(medians[i]);
        }
    Verdict verdict{.shift = sum.pixels > 0 ? sum.spikes / sum.pixels : 0};
    const double samples = sum.regular > 0 ? sum.samples / sum.regular : 0;
    const double vov = sum.squares > 0 ? (sum.fourth / sum.squares - 1) / samples : 0;
    verdict.holds = vov < kMostVov && verdict.shift <= kMostShift * medianOf(typical);
    return verdict;
}

}  // namespace

std::vector<bool> trustedPixels(std::size_t pixels, const std::function<JudgedPixel(std::size_t)>& pixelAt,
                                glm::uvec2 grid, std::uint32_t radius) {
    std::vector<Cell> cells(std::size_t{grid.x} * grid.y);
    for (std::size_t i = 0; i < pixels; ++i) {
        const JudgedPixel pixel = pixelAt(i);
        add(cells[std::size_t{pixel.cell.y} * grid.x + pixel.cell.x], pixel);
    }
    std::vector<double> medians;
    for (Cell& cell : cells) medians.push_back(medianOf(cell.errors));
    std::vector<Verdict> verdicts;
    for (std::uint32_t y = 0; y < grid.y; ++y)
        for (std::uint32_t x = 0; x < grid.x; ++x) verdicts.push_back(judge(cells, medians, grid, {x, y}, radius));
    std::vector<bool> trusted(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const JudgedPixel pixel = pixelAt(i);
        const Verdict& verdict = verdicts[std::size_t{pixel.cell.y} * grid.x + pixel.cell.x];
        const PixelMoments& m = pixel.moments;
        trusted[i] = verdict.holds && m.isFinite && m.samples >= 2 && !m.isDark() &&
                     verdict.shift <= kMostShift * standardError(pixel);
    }
    return trusted;
}

}  // namespace parhelion
