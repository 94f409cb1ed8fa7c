#include "compile/alias_table.h"

#include <numeric>

namespace parhelion {

namespace {

constexpr std::uint64_t kWords = std::uint64_t(1) << 32;

/// How many words w have w * count in [from, to).
std::uint64_t wordsBetween(std::uint64_t from, std::uint64_t to, std::uint64_t count) {
    return (to + count - 1) / count - (from + count - 1) / count;
}

/// Buckets of equal height filled from what lies below and what lies above it.
void fillBuckets(std::span<const double> weights, std::vector<glm::uvec2>& entries) {
    const auto count = std::uint32_t(weights.size());
    const double scale = count / std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<double> height(count);
    std::vector<std::uint32_t> below, above;
    for (std::uint32_t i = 0; i < count; ++i) {
        height[i] = weights[i] * scale;
        (height[i] < 1.0 ? below : above).push_back(i);
    }
    while (!below.empty() && !above.empty()) {
        const std::uint32_t low = below.back(), high = above.back();
        below.pop_back();
        entries[low] = {std::uint32_t(height[low] * double(kWords)), high};
        height[high] -= 1.0 - height[low];
        if (height[high] < 1.0) {
            above.pop_back();
            below.push_back(high);
        }
    }
    // What is left has height 1 up to rounding; but a weight of 0 must not be found.
    for (const std::uint32_t rest : above) entries[rest] = {0, rest};
    std::uint32_t heaviest = 0;
    for (std::uint32_t i = 1; i < count; ++i) heaviest = weights[i] > weights[heaviest] ? i : heaviest;
    for (const std::uint32_t rest : below) entries[rest] = {0, weights[rest] > 0.0 ? rest : heaviest};
}

}  // namespace

AliasTable buildAliasTable(std::span<const double> weights) {
    AliasTable table;
    const std::uint64_t count = weights.size();
    table.entries.resize(count);
    fillBuckets(weights, table.entries);
    std::vector<std::uint64_t> words(count, 0);
    for (std::uint64_t bucket = 0; bucket < count; ++bucket) {
        const auto [threshold, alias] = std::pair(table.entries[bucket].x, table.entries[bucket].y);
        const std::uint64_t first = bucket * kWords;
        words[bucket] += wordsBetween(first, first + threshold, count);
        words[alias] += wordsBetween(first + threshold, first + kWords, count);
    }
    table.probabilities.reserve(count);
    for (const std::uint64_t chosen : words) table.probabilities.push_back(double(chosen) / double(kWords));
    return table;
}

}  // namespace parhelion
