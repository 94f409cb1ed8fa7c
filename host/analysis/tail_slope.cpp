#include "analysis/tail_slope.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace parhelion {

double tailSlope(std::vector<double> values) {
    constexpr std::size_t kMost = 201, kLeast = 500;
    constexpr double kSteepest = 10;
    std::erase_if(values, [](double value) { return !(value > 0) || !std::isfinite(value); });
    if (values.size() < kLeast) return kSteepest;
    const std::size_t count = std::min(kMost, values.size() / 20);
    std::ranges::partial_sort(values, values.begin() + static_cast<std::ptrdiff_t>(count) + 1, std::greater());
    double logs = 0;
    for (std::size_t i = 0; i < count; ++i) logs += std::log(values[i] / values[count]) / static_cast<double>(count);
    return logs > 0 ? std::min(kSteepest, 1 + 1 / logs) : kSteepest;
}

}  // namespace parhelion
