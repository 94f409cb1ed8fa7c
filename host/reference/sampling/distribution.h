#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

namespace parhelion::reference {

/// Index of the first entry above u; the last entry must be above every u asked for.
template <typename Real>
std::uint32_t firstAbove(std::span<const float> cdf, Real u) {
    const auto above = std::upper_bound(cdf.begin(), cdf.end(), u, [](Real a, float b) { return a < Real(b); });
    return static_cast<std::uint32_t>(above - cdf.begin());
}

}  // namespace parhelion::reference
