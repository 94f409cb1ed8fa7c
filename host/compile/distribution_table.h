#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace parhelion {

/// A discrete distribution that one 32-bit word samples by inversion: neighbouring words choose the same entry or
/// neighbouring ones, and what is left of a word places within the entry (shaders/README.md, "Distributions").
///
/// Words from texels[i].x on, below texels[i + 1].x, choose entry i; 2^32 is stored as 0. texels[b].y is the entry of
/// the least word w with w * n >> 32 = b, texels[n].y the last entry that has words: where a search begins and ends.
struct DistributionTable {
    std::vector<glm::uvec2> texels;     ///< (edge, guide), one more than entries
    std::vector<double> probabilities;  ///< of each entry, exactly: multiples of 2^-32
};

/// @param weights     finite, >= 0, not all 0; fewer than 2^27. Only those above 0 get words, all of them; how many is
///                    within one of the share of 2^32 where that is more than leastWords, and where no run of entries
///                    below it comes right before or behind.
/// @param leastWords  of each entry with a weight; times the number of weights at most 2^32.
DistributionTable buildDistribution(std::span<const double> weights, std::uint32_t leastWords = 1);

/// What zoomWord divides by a width of `words`: floor((2^64 - 1) / d) - 2^32, d being `words` with its leading zeros
/// shifted out; 0 for 0, which stands for all words.
std::uint32_t reciprocalOf(std::uint32_t words);

}  // namespace parhelion
