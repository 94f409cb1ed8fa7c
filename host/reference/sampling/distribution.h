#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace parhelion::reference {

/// Index of the first entry above u; the last entry must be above every u asked for.
template <typename Real>
std::uint32_t firstAbove(std::span<const float> cdf, Real u) {
    const auto above = std::upper_bound(cdf.begin(), cdf.end(), u, [](Real a, float b) { return a < Real(b); });
    return static_cast<std::uint32_t>(above - cdf.begin());
}

/// Outcome of an alias table (compile/alias_table.h) for a random word.
inline std::uint32_t sampleAlias(std::span<const glm::uvec2> entries, std::uint32_t word) {
    const std::uint64_t scaled = std::uint64_t(word) * entries.size();
    const auto bucket = std::uint32_t(scaled >> 32);
    return std::uint32_t(scaled) < entries[bucket].x ? bucket : entries[bucket].y;
}

}  // namespace parhelion::reference
