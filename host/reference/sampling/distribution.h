#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>

namespace parhelion::reference {

/// What a word chooses, and where in it, in [0, 1); `left` is the rest of the way, with the digits of its own.
template <typename Real>
struct Choice {
    std::uint32_t entry;
    Real offset, left;
};

/// Inverse of a distribution function (shaders/README.md, "Distributions").
///
/// @param table  (edge, guide) of each entry and of the end: no entry beyond its last guide has any words.
/// @param fill   in [0, 1): the digits that the word lacks.
template <typename Real>
Choice<Real> invertDistribution(std::span<const glm::uvec2> table, std::uint32_t word, Real fill) {
    const std::size_t bucket = std::size_t((table.size() - 1) * std::uint64_t(word) >> 32), last = table.back().y;
    const auto startsAbove = [](std::uint32_t w, const glm::uvec2& entry) { return w < entry.x; };
    const auto above =
        std::upper_bound(table.begin() + table[bucket].y, table.begin() + table[bucket + 1].y + 1, word, startsAbove);
    const auto entry = std::size_t(above - table.begin()) - 1;
    const std::uint64_t from = table[entry].x, end = entry == last ? std::uint64_t(1) << 32 : table[entry + 1].x;
    constexpr Real kBelowOne = 1 - std::numeric_limits<Real>::epsilon() / 2;
    const Real width(end - from);
    return {std::uint32_t(entry), std::min((Real(word - from) + fill) / width, kBelowOne),
            (Real(end - word - 1) + (1 - fill)) / width};
}

/// Quotient and remainder of high 2^32 + low.
inline glm::uvec2 divideWide(std::uint32_t high, std::uint32_t low, std::uint32_t divisor) {
    const std::uint64_t dividend = std::uint64_t(high) << 32 | low;
    return {std::uint32_t(dividend / divisor), std::uint32_t(dividend % divisor)};
}

/// Two uniform words from two, of which the first lies in [below, below + width), monotone in it; width 0: all words.
inline glm::uvec2 zoomWord(const glm::uvec2& words, std::uint32_t below, std::uint32_t width) {
    if (width == 0) return words;
    const glm::uvec2 first = divideWide(words.x - below, words.y, width);
    return {first.x, divideWide(first.y, 0, width).x};
}

}  // namespace parhelion::reference
