#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

#include "support/gpu_fixture.h"

namespace parhelion {
namespace {

using test::probe;

/// 16 bytes of a table that function 1 reads and function 0 does not.
class Probe : public testing::Test {
protected:
    gpu::Buffer table_ = test::testDevice().createBuffer(16);
    std::array<gpu::Binding, 1> extra_{{{.index = 5, .view = table_.texelView(VK_FORMAT_R32_SFLOAT)}}};
};

TEST_F(Probe, ReturnsOneRowForEachItemAlsoBeyondOneGroup) {
    std::vector<glm::vec4> inputs;
    for (int i = 0; i < 1000; ++i) inputs.emplace_back(i, -i, 0.5f, 1e30f);
    const auto outputs = probe("unit/probe.comp", 0, inputs, 1, 1, {{7, 2.0f}}, extra_);
    ASSERT_EQ(outputs.size(), inputs.size());
    for (std::size_t i = 0; i < inputs.size(); ++i) EXPECT_EQ(outputs[i], 2.0f * inputs[i]) << i;
}

TEST_F(Probe, KeepsSeveralInputsAndOutputsOfAnItemTogether) {
    table_.as<float>()[1] = 3.5f;
    const std::array inputs{glm::vec4(1), glm::vec4(10), glm::vec4(2), glm::vec4(20), glm::vec4(3), glm::vec4(30)};
    const auto outputs = probe("unit/probe.comp", 1, inputs, 2, 2, {}, extra_);
    ASSERT_EQ(outputs.size(), 6u);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(outputs[2 * i], glm::vec4(11 * (i + 1)));
        EXPECT_EQ(outputs[2 * i + 1], glm::vec4(i, 3, 3.5f, 0));
    }
}

TEST_F(Probe, RefusesHalfAnItem) {
    const std::array inputs{glm::vec4(1), glm::vec4(2), glm::vec4(3)};
    EXPECT_THROW(probe("unit/probe.comp", 1, inputs, 2, 2, {}, extra_), std::invalid_argument);
}

TEST_F(Probe, ReturnsNothingForNothing) { EXPECT_TRUE(probe("unit/probe.comp", 0, {}, 1, 1, {}, extra_).empty()); }

}  // namespace
}  // namespace parhelion
