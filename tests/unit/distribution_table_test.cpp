#include "compile/distribution_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace parhelion {
namespace {

constexpr std::uint64_t kWords = std::uint64_t(1) << 32;

std::vector<double> hardWeights(std::size_t count) {
    std::mt19937 random(unsigned(count + 1));
    std::vector<double> weights(count);
    for (double& weight : weights) weight = random() % 4 == 0 ? 0.0 : std::exp(20.0 * (random() / 4294967296.0 - 0.5));
    weights[count / 2] = 1e6;
    return weights;
}

/// First words of the entries and the end, from the stored ones; entries of no words at the end begin there.
std::vector<std::uint64_t> edges(const DistributionTable& table) {
    std::vector<std::uint64_t> found;
    const std::uint32_t last = table.texels.back().y;
    for (std::uint32_t i = 0; i < table.texels.size(); ++i)
        found.push_back(i > last ? kWords : std::uint64_t(table.texels[i].x));
    return found;
}

TEST(DistributionTable, EntriesGetTheirShareOfTheWordsOrTheLeastThereIs) {
    for (const std::size_t count : {1u, 2u, 3u, 7u, 256u, 1000u, 4096u})
        for (const std::uint32_t least : {1u, 8u}) {
            const std::vector<double> weights = hardWeights(count);
            const DistributionTable table = buildDistribution(weights, least);
            const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
            const std::vector<std::uint64_t> edge = edges(table);
            double total = 0, running = 0;
            std::size_t tiny = 0;
            for (std::size_t i = 0; i < count; ++i) {
                const std::uint64_t words = edge[i + 1] - edge[i];
                EXPECT_EQ(table.probabilities[i], double(words) / double(kWords)) << i;
                total += table.probabilities[i];
                running += weights[i];
                tiny += weights[i] > 0 && weights[i] / sum * double(kWords) < least;
                EXPECT_TRUE(weights[i] == 0 ? words == 0 : words >= least) << i;
                // Running sums are rounded once; entries that need more than their share push the next ones up, or are
                // made room for: by their least words and no more.
                EXPECT_NEAR(double(edge[i + 1]), running / sum * double(kWords),
                            1.0 + double(least) * double(tiny + count))
                    << i;
            }
            EXPECT_EQ(total, 1.0);
            EXPECT_EQ(table.texels.back().x, 0u);
        }
}

TEST(DistributionTable, GuidesBoundTheEntryOfEveryWord) {
    for (const std::size_t count : {1u, 3u, 5u, 16u, 1000u}) {
        const DistributionTable table = buildDistribution(hardWeights(count));
        const std::vector<std::uint64_t> edge = edges(table);
        for (std::uint64_t word = 0; word < kWords; word += word % 5 == 0 ? 1 : 40'961) {
            const std::uint64_t bucket = word * count >> 32;
            const std::uint32_t low = table.texels[bucket].y, high = table.texels[bucket + 1].y;
            const auto entry = std::size_t(std::upper_bound(edge.begin(), edge.end(), word) - edge.begin()) - 1;
            ASSERT_GE(entry, low) << word;
            ASSERT_LE(entry, high) << word;
            ASSERT_GT(table.probabilities[entry], 0.0);
        }
    }
}

// Weights at the limits of double neither overflow nor lose their words.
TEST(DistributionTable, TakesWeightsOfAnySize) {
    const DistributionTable table = buildDistribution(std::vector<double>{1e308, 5e-324, 0.0, 1.5e308, 1e308}, 8);
    EXPECT_EQ(table.probabilities[1], 8 * 0x1p-32);
    EXPECT_EQ(table.probabilities[2], 0.0);
    EXPECT_NEAR(table.probabilities[3], 1.5 / 3.5, 1e-8);
    EXPECT_EQ(std::accumulate(table.probabilities.begin(), table.probabilities.end(), 0.0), 1.0);
}

TEST(DistributionTable, EveryOneOfManyTinyEntriesIsReachable) {
    std::vector<double> weights(1u << 20, 1e-30);
    weights.front() = weights.back() = 1;
    const DistributionTable table = buildDistribution(weights, 8);
    for (std::size_t i = 1; i + 1 < weights.size(); ++i) ASSERT_EQ(table.probabilities[i], 8 * 0x1p-32) << i;
    EXPECT_EQ(std::accumulate(table.probabilities.begin(), table.probabilities.end(), 0.0), 1.0);
}

}  // namespace
}  // namespace parhelion
