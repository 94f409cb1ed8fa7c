#include "base/parallel.h"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/memory.h"

namespace parhelion {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnce) {
    for (const std::size_t count : {0u, 1u, 2u, 1000u, 100'003u})
        for (const std::size_t grain : {1u, 7u, 1'000'000u}) {
            std::vector<int> visits(count, 0);
            parallelFor(
                count, [&](std::size_t i) { ++visits[i]; }, grain);
            EXPECT_EQ(std::accumulate(visits.begin(), visits.end(), std::size_t{0}), count);
            EXPECT_EQ(visits, std::vector<int>(count, 1));
        }
}

TEST(ParallelFor, ThrowsTheFailureOfTheLowestIndexEveryTime) {
    for (int repetition = 0; repetition < 200; ++repetition) {
        std::string message;
        try {
            parallelFor(1000, [](std::size_t i) {
                if (i % 100 == 37) throw std::runtime_error(std::to_string(i));
            });
        } catch (const std::runtime_error& error) {
            message = error.what();
        }
        ASSERT_EQ(message, "37");
    }
}

TEST(PhysicalMemory, IsPlausible) {
    EXPECT_GT(physicalMemoryBytes(), std::size_t{64} << 20);
    EXPECT_LT(physicalMemoryBytes(), std::size_t{1} << 50);
}

}  // namespace
}  // namespace parhelion
