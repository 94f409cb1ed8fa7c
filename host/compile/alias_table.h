#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace parhelion {

/// A discrete distribution that one 32-bit word samples with one look-up, and with exactly known probabilities.
///
/// Word w falls into bucket b = floor(w * n / 2^32) with the rest r = w * n mod 2^32; the outcome is b where
/// r < entries[b].x, and entries[b].y elsewhere.
///
/// Source: Vose 1991, "A Linear Algorithm for Generating Random Numbers with a Given Distribution".
struct AliasTable {
    std::vector<glm::uvec2> entries;    ///< (threshold, alias)
    std::vector<double> probabilities;  ///< of each outcome, as the 2^32 words give them: multiples of 2^-32
};

/// @param weights  finite, >= 0, not all 0; fewer than 2^32. A weight of 0 has probability 0; one below about 2^-32 of
///                 the sum may get 0 too, and the steps of 2^-32 show where there are very many.
AliasTable buildAliasTable(std::span<const double> weights);

}  // namespace parhelion
