#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "reference/sampling/distribution.h"
#include "support/goodness.h"

/// Random words for tests that think in uniform numbers.
namespace parhelion::test {

/// The word of a number in [0, 1).
inline std::uint32_t wordOf(double u) { return std::uint32_t(u * 0x1p32); }
template <typename Real>
glm::uvec2 wordsOf(const glm::vec<2, Real>& u) {
    return {wordOf(double(u.x)), wordOf(double(u.y))};
}

/// x, y and z of a light draw where one light is at (u, v); z lends half a step.
template <typename Real>
glm::uvec3 lightWords(const glm::vec<2, Real>& u) {
    return {wordsOf(u), 0x80008000u};
}

/// A word that chooses the same entry, at a bent offset in it: a seeded defect of what places within entries.
inline std::uint32_t bentWithin(std::span<const glm::uvec2> table, std::uint32_t word, double bend) {
    const auto [entry, offset, left] = reference::invertDistribution(table, word, 0.5);
    const double width = double(table[entry + 1].x - table[entry].x - 1u) + 1;
    return table[entry].x + std::uint32_t(bent(offset, bend) * width);
}

}  // namespace parhelion::test
