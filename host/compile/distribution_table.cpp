#include "compile/distribution_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace parhelion {

namespace {

constexpr std::uint64_t kWords = std::uint64_t(1) << 32;

/// First word of each entry, and the end, 2^32.
std::vector<std::uint64_t> edgesOf(std::span<const double> weights, std::uint64_t leastWords) {
    // In units of the largest: weights near the limits of double must not overflow.
    const double largest = *std::ranges::max_element(weights);
    double total = 0.0;
    std::uint64_t behind = 0;  // entries with words that are still to come
    for (const double weight : weights) {
        total += weight / largest;
        behind += weight > 0.0;
    }
    std::vector<std::uint64_t> edges{0};
    edges.reserve(weights.size() + 1);
    double running = 0.0;
    for (const double weight : weights) {
        std::uint64_t end = edges.back();
        if (weight > 0.0) {
            running += weight / largest;
            const auto share = std::uint64_t(std::nearbyint(running / total * double(kWords)));
            end = std::clamp(share, end + leastWords, kWords - --behind * leastWords);
            if (behind == 0) end = kWords;
        }
        edges.push_back(end);
    }
    return edges;
}

}  // namespace

DistributionTable buildDistribution(std::span<const double> weights, std::uint32_t leastWords) {
    const std::vector<std::uint64_t> edges = edgesOf(weights, leastWords);
    const std::uint64_t count = weights.size();
    DistributionTable table;
    table.texels.reserve(count + 1);
    table.probabilities.reserve(count);
    std::uint64_t entry = 0;
    for (std::uint64_t bucket = 0; bucket <= count; ++bucket) {
        const std::uint64_t least = bucket < count ? (bucket * kWords + count - 1) / count : kWords - 1;
        while (edges[entry + 1] <= least) ++entry;
        table.texels.emplace_back(std::uint32_t(edges[bucket]), std::uint32_t(entry));
    }
    for (std::uint64_t i = 0; i < count; ++i)
        table.probabilities.push_back(double(edges[i + 1] - edges[i]) / double(kWords));
    return table;
}

std::uint32_t reciprocalOf(std::uint32_t words) {
    if (words == 0) return 0;
    return std::uint32_t(~std::uint64_t(0) / (std::uint64_t(words) << std::countl_zero(words)) - kWords);
}

}  // namespace parhelion
