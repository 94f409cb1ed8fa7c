#include <gtest/gtest.h>

#include <bit>

#include "shared/path_types.h"
#include "support/gpu_fixture.h"

namespace parhelion::test {
namespace {

// A million lanes with thousands of steps each take more than 2^32 in one dispatch.
TEST(Counters, AddUpBeyond32Bits) {
    constexpr std::uint32_t kLanes = 4096, kEach = 12'345'678;
    gpu::Buffer counters = testDevice().createBuffer(shared::kCounterCount * sizeof(std::uint64_t));
    const std::vector<glm::vec4> inputs(kLanes, glm::vec4(std::bit_cast<float>(kEach)));
    const std::vector<gpu::Binding> bindings{{.index = 14, .buffer = counters.handle()}};
    probe("unit/counters.comp", 0, inputs, 1, 1, {}, bindings);
    const auto words = counters.as<std::uint32_t>();
    const auto total = [&](std::uint32_t counter) {
        return words[counter] | std::uint64_t{words[shared::kCounterCount + counter]} << 32;
    };
    EXPECT_EQ(total(shared::kCounterSteps), std::uint64_t{kLanes} * kEach);
    EXPECT_EQ(total(shared::kCounterVertices), kLanes);
    EXPECT_EQ(total(shared::kCounterCollisions), 0u);
}

}  // namespace
}  // namespace parhelion::test
