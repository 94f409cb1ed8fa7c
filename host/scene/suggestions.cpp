#include "scene/suggestions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace parhelion {
namespace {

/// Levenshtein distance, one row at a time.
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
        }
    }
    return row.back();
}

}  // namespace

std::string nearestName(std::string_view name, std::span<const std::string> allowed) {
    constexpr std::size_t kLongestName = 256;  // nobody mistypes more; bounds the quadratic cost
    if (name.size() > kLongestName) return {};
    std::size_t best = std::max<std::size_t>(2, name.size() / 3) + 1;
    std::string nearest;
    for (const std::string& candidate : allowed) {
        const std::size_t distance = editDistance(name, candidate);
        if (distance >= best || distance >= candidate.size()) continue;
        best = distance;
        nearest = candidate;
    }
    return nearest;
}

std::string suggest(std::string_view name, std::span<const std::string> allowed) {
    const std::string nearest = nearestName(name, allowed);
    const std::string hint = nearest.empty() ? "; " : fmt::format("; did you mean \"{}\"? ", nearest);
    if (allowed.empty()) return hint + "none is allowed here";
    return fmt::format("{}{} {}", hint, nearest.empty() ? "allowed:" : "Allowed:", fmt::join(allowed, ", "));
}

}  // namespace parhelion
