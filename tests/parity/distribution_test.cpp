// shaders/sampling/distribution.glsl: the same entry and the same words, always.
#include "reference/sampling/distribution.h"

#include <gtest/gtest.h>

#include <bit>

#include "compile/distribution_table.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::Parity;
using test::Stress;

const char* const kShader = "parity/distribution.comp";
enum Function : std::uint32_t { kInvert, kDivide, kZoom };

/// Words at and next to edges, at both ends, and any.
std::vector<std::uint32_t> hardWords(std::span<const glm::uvec2> table, Stress& stress) {
    std::vector<std::uint32_t> words{0, 1, 0x7fffffffu, 0x80000000u, 0xfffffffeu, 0xffffffffu};
    const std::size_t stride = std::max<std::size_t>(table.size() / 3'000, 1);
    for (std::size_t i = 0; i < table.size(); i += stride)
        words.insert(words.end(), {table[i].x, table[i].x - 1u, stress.word()});
    return words;
}

void expectSameChoices(const std::vector<double>& weights, std::uint32_t leastWords) {
    const DistributionTable table = buildDistribution(weights, leastWords);
    CompiledScene scene;
    scene.distributions.assign(7, glm::uvec2(0x80000000u, 3));  // of a table before
    scene.distributions.insert(scene.distributions.end(), table.texels.begin(), table.texels.end());
    const auto count = std::uint32_t(weights.size());
    Stress stress(count);
    const std::vector<std::uint32_t> words = hardWords(table.texels, stress);
    std::vector<glm::vec4> inputs;
    for (const std::uint32_t word : words)
        inputs.emplace_back(glm::uintBitsToFloat(glm::uvec3(7, count, word)), stress.between(0, 1));
    const auto outputs = test::SceneProbe(scene).run(kShader, kInvert, inputs);
    Parity entry("sampling/distribution", "invertDistribution", 0);
    // Conversions of the rest and the width, a sum, a quotient: 2 + 1 + 2.5, of 1.
    Parity offset("sampling/distribution", "invertDistribution", 6);
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto expected = reference::invertDistribution(table.texels, words[i], double(inputs[i].w));
        EXPECT_TRUE(entry.equal(glm::floatBitsToUint(outputs[i].x), expected.entry)) << words[i] << " of " << count;
        EXPECT_TRUE(offset.near(outputs[i].y, expected.offset, 1)) << words[i] << " of " << count;
        EXPECT_TRUE(offset.near(outputs[i].z, expected.left)) << words[i] << " of " << count;
        EXPECT_LT(outputs[i].y, 1.0f);
        EXPECT_GT(table.probabilities[expected.entry], 0.0);
    }
}

TEST(DistributionParity, EveryWordChoosesTheSame) {
    for (const std::uint32_t count : {1u, 2u, 3u, 255u, 256u, 257u, 5000u}) {
        std::vector<double> weights(count);
        Stress stress(count);
        for (double& weight : weights) weight = stress.word() % 3 == 0 ? 0.0 : stress.magnitude(1e-12f, 1);
        weights[count / 2] = 1;
        expectSameChoices(weights, 1);
        expectSameChoices(weights, 8);
        // Crowded: all but one entry in one bucket.
        for (std::uint32_t i = 0; i < count; ++i) weights[i] = i == count / 2 ? 1.0 : 1e-300;
        expectSameChoices(weights, 1);
        // Nothing at either end.
        for (std::uint32_t i = 0; i < count; ++i) weights[i] = i == count / 2 ? 1.0 : 0.0;
        expectSameChoices(weights, 8);
    }
}

// H44: more entries than a float counts, and of 256 words each.
TEST(DistributionParity, LargeTablesChooseTheSame) { expectSameChoices(std::vector<double>((1u << 24) + 3, 1.0), 1); }

TEST(DistributionParity, WideQuotientsAgree) {
    std::vector<glm::vec4> inputs;
    Stress stress(12);
    for (int i = 0; i < 20'000; ++i) {
        const std::uint32_t divisor = i % 3 == 0   ? 0x80000000u + i
                                      : i % 3 == 1 ? 0xffffffffu - i
                                                   : stress.word() | 0x80000000u;
        const std::uint32_t high = i % 5 == 0 ? divisor - 1 : i % 5 == 1 ? 0 : stress.word() % divisor;
        const std::uint32_t low = i % 7 == 0 ? 0xffffffffu : i % 7 == 1 ? 0 : stress.word();
        inputs.push_back(glm::uintBitsToFloat(glm::uvec4(high, low, divisor, reciprocalOf(divisor))));
    }
    const auto outputs = test::SceneProbe(CompiledScene{}).run(kShader, kDivide, inputs);
    Parity parity("sampling/distribution", "divideWide", 0);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::uvec4 in = glm::floatBitsToUint(inputs[i]), out = glm::floatBitsToUint(outputs[i]);
        const glm::uvec2 expected = reference::divideWide(in.x, in.y, in.z);
        EXPECT_TRUE(parity.equal(out.x, expected.x)) << i;
        EXPECT_TRUE(parity.equal(out.y, expected.y)) << i;
    }
}

TEST(DistributionParity, ZoomedWordsAgree) {
    std::vector<glm::vec4> inputs;
    Stress stress(13);
    for (int i = 0; i < 20'000; ++i) {
        // Widths of lights are multiples of 2^8; 0 stands for all words.
        const std::uint32_t width = i % 9 == 0 ? 0 : (stress.word() >> i % 24) | 1u << 8;
        const std::uint32_t below = width == 0 ? 0 : std::uint32_t(stress.word() * std::uint64_t(-width) >> 32);
        const std::uint32_t rest = width == 0   ? stress.word()
                                   : i % 5 == 0 ? width - 1
                                   : i % 5 == 1 ? 0
                                                : stress.word() % width;
        inputs.push_back(glm::uintBitsToFloat(glm::uvec4(below + rest, stress.word(), below, width)));
        inputs.emplace_back(glm::uintBitsToFloat(reciprocalOf(width)), 0, 0, 0);
    }
    const auto outputs = test::SceneProbe(CompiledScene{}).run(kShader, kZoom, inputs, 2, 1);
    Parity parity("sampling/distribution", "zoomWord", 0);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const glm::uvec4 in = glm::floatBitsToUint(inputs[2 * i]), out = glm::floatBitsToUint(outputs[i]);
        const glm::uvec2 expected = reference::zoomWord({in.x, in.y}, in.z, in.w);
        EXPECT_TRUE(parity.equal(out.x, expected.x)) << i;
        EXPECT_TRUE(parity.equal(out.y, expected.y)) << i;
    }
}

}  // namespace
}  // namespace parhelion
