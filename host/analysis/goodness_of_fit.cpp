#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "analysis/statistics.h"

namespace parhelion {

namespace {

/// One or more of the caller's cells.
struct Cell {
    std::string label;
    double observed = 0;
    double expected = 0;

    double contribution() const {
        if (expected > 0) return (observed - expected) * (observed - expected) / expected;
        return observed > 0 ? std::numeric_limits<double>::infinity() : 0.0;
    }
};

void requireCounts(std::span<const double> counts, const char* name) {
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (!std::isfinite(counts[i]) || counts[i] < 0)
            throw std::invalid_argument(fmt::format("{} count {} must be finite and >= 0; got {}", name, i, counts[i]));
}

/// Which cells to pool: all expected below minExpected, and the next smallest until the pool reaches it.
std::vector<bool> choosePool(std::span<const double> expected, double minExpected) {
    std::vector<std::size_t> order(expected.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return expected[a] < expected[b]; });
    std::vector<bool> pooled(expected.size(), false);
    double sum = 0;
    bool any = false;
    for (const std::size_t i : order) {
        if (expected[i] == 0) continue;
        if (expected[i] >= minExpected && (!any || sum >= minExpected)) break;
        pooled[i] = any = true;
        sum += expected[i];
    }
    return pooled;
}

/// Cells fit for the chi-square approximation, the pool last. Cells of expectation zero are left out unless hit.
std::vector<Cell> poolCells(std::span<const double> observed, std::span<const double> expected, double minExpected) {
    const std::vector<bool> pooled = choosePool(expected, minExpected);
    std::vector<Cell> cells;
    Cell pool;
    for (std::size_t i = 0; i < observed.size(); ++i) {
        if (pooled[i]) {
            pool.observed += observed[i];
            pool.expected += expected[i];
        } else if (expected[i] > 0 || observed[i] > 0) {
            cells.push_back({fmt::format("{}", i), observed[i], expected[i]});
        }
    }
    const auto count = std::count(pooled.begin(), pooled.end(), true);
    if (count > 0) cells.push_back({fmt::format("pool of {}", count), pool.observed, pool.expected});
    return cells;
}

std::string tableOf(const std::vector<Cell>& cells) {
    std::string table = fmt::format("{:>12} {:>14} {:>14} {:>12}\n", "cell", "observed", "expected", "contribution");
    for (const Cell& cell : cells)
        fmt::format_to(std::back_inserter(table), "{:>12} {:>14.8g} {:>14.8g} {:>12.4g}\n", cell.label, cell.observed,
                       cell.expected, cell.contribution());
    return table;
}

/// P(K > lambda) for Kolmogorov's limiting distribution.
double kolmogorovTail(double lambda) {
    if (lambda < 0.2) return 1;  // the tail differs from 1 by less than 1e-12, and the series stops converging
    double sum = 0;
    for (int k = 1; k <= 40; ++k) sum += (k % 2 == 1 ? 2 : -2) * std::exp(-2.0 * k * k * lambda * lambda);
    return std::clamp(sum, 0.0, 1.0);
}

}  // namespace

ChiSquare chiSquareTest(std::span<const double> observed, std::span<const double> expected, double minExpected) {
    if (observed.size() != expected.size())
        throw std::invalid_argument(fmt::format("as many observed counts as expected ones are needed; got {} and {}",
                                                observed.size(), expected.size()));
    requireCounts(observed, "observed");
    requireCounts(expected, "expected");
    const std::vector<Cell> cells = poolCells(observed, expected, minExpected);
    const auto possible = std::count_if(cells.begin(), cells.end(), [](const Cell& cell) { return cell.expected > 0; });
    if (possible < 2)
        throw std::invalid_argument(fmt::format("a chi-square test needs two cells after pooling; got {}", possible));
    ChiSquare result;
    for (const Cell& cell : cells) result.statistic += cell.contribution();
    result.degreesOfFreedom = static_cast<int>(possible) - 1;
    result.pValue = chiSquareTail(result.statistic, result.degreesOfFreedom);
    result.table = tableOf(cells) + fmt::format("chi-square {:.6g}, {} degrees of freedom, p = {:.4g}\n",
                                                result.statistic, result.degreesOfFreedom, result.pValue);
    return result;
}

KolmogorovSmirnov kolmogorovSmirnovTest(std::vector<double> samples, const std::function<double(double)>& cdf) {
    if (samples.empty()) throw std::invalid_argument("a Kolmogorov-Smirnov test needs samples; got none");
    if (std::any_of(samples.begin(), samples.end(), [](double x) { return std::isnan(x); }))
        throw std::invalid_argument("samples of a Kolmogorov-Smirnov test must be numbers; got NaN");
    std::sort(samples.begin(), samples.end());
    const double n = static_cast<double>(samples.size());
    KolmogorovSmirnov result;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double expected = cdf(samples[i]);
        if (!(expected >= 0 && expected <= 1))
            throw std::invalid_argument(
                fmt::format("a distribution function must be in [0, 1]; got {} at {}", expected, samples[i]));
        const double below = static_cast<double>(i) / n, upTo = static_cast<double>(i + 1) / n;
        result.statistic = std::max({result.statistic, expected - below, upTo - expected});
    }
    const double root = std::sqrt(n);
    result.pValue = kolmogorovTail((root + 0.12 + 0.11 / root) * result.statistic);
    return result;
}

}  // namespace parhelion
