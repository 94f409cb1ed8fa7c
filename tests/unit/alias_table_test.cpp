#include "compile/alias_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace parhelion {
namespace {

/// Outcome of a word by the definition in the header.
std::uint32_t outcome(const AliasTable& table, std::uint32_t word) {
    const std::uint64_t scaled = std::uint64_t(word) * table.entries.size();
    const glm::uvec2 entry = table.entries[scaled >> 32];
    return std::uint32_t(scaled) < entry.x ? std::uint32_t(scaled >> 32) : entry.y;
}

std::vector<double> hardWeights(std::size_t count) {
    std::mt19937 random(unsigned(count + 1));
    std::vector<double> weights(count);
    for (double& weight : weights) weight = random() % 4 == 0 ? 0.0 : std::exp(20.0 * (random() / 4294967296.0 - 0.5));
    weights[count / 2] = 1e6;
    return weights;
}

// Every weight moves by at most one word per bucket it appears in: itself and what it fills, so the sum of all errors
// stays below one word for each end of each piece, 4 n words of 2^32.
TEST(AliasTable, ProbabilitiesFollowTheWeights) {
    for (const std::size_t count : {1u, 2u, 3u, 7u, 256u, 1000u, 4096u}) {
        const std::vector<double> weights = hardWeights(count);
        const AliasTable table = buildAliasTable(weights);
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
        double error = 0, total = 0;
        for (std::size_t i = 0; i < count; ++i) {
            error += std::abs(table.probabilities[i] - weights[i] / sum);
            total += table.probabilities[i];
            if (weights[i] == 0) {
                EXPECT_EQ(table.probabilities[i], 0) << i << " of " << count;
            }
        }
        EXPECT_EQ(total, 1.0);
        EXPECT_LE(error, 4.0 * double(count) * 0x1p-32) << count;
    }
}

// A stride through all words of coarse tables: the counts in a run of words match to the pieces' ends.
TEST(AliasTable, StatedProbabilitiesAreThoseOfTheWords) {
    for (const std::size_t count : {1u, 3u, 5u, 16u}) {
        const AliasTable table = buildAliasTable(hardWeights(count));
        constexpr std::uint32_t kStride = 4093;
        std::vector<double> share(count);
        double words = 0;
        for (std::uint64_t word = 0; word < (std::uint64_t(1) << 32); word += kStride, ++words)
            ++share[outcome(table, std::uint32_t(word))];
        // Each of the 2 n pieces is an interval of words: a stride misjudges it by one word at most.
        for (std::size_t i = 0; i < count; ++i)
            EXPECT_NEAR(share[i] / words, table.probabilities[i], 2.0 * double(count) / words) << i << " of " << count;
    }
}

}  // namespace
}  // namespace parhelion
