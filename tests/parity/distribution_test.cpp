// shaders/sampling/distribution.glsl: the same entry, always.
#include "reference/sampling/distribution.h"

#include <gtest/gtest.h>

#include "compile/alias_table.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::Parity;
using test::Stress;

/// Running fractions of the weights, summed in Sum. The last is 1.
template <typename Sum>
std::vector<float> runningFractions(const std::vector<float>& weights) {
    Sum total = 0;
    for (const float weight : weights) total += weight;
    std::vector<float> cdf;
    Sum sum = 0;
    for (const float weight : weights) cdf.push_back(float((sum += weight) / total));
    cdf.back() = 1;
    return cdf;
}

void expectSameEntries(const std::vector<float>& cdf, std::uint32_t offset, std::uint32_t count) {
    CompiledScene scene;
    scene.lightTriangleCdf = cdf;
    std::vector<float> uniforms = test::stressUniforms(2'000);
    for (std::uint32_t i = 0; i < std::min(count, 2'000u); ++i) {
        const float entry = cdf[offset + i];
        uniforms.insert(uniforms.end(), {std::min(entry, 0x1.fffffep-1f), std::nextafter(entry, 0.0f)});
    }
    std::vector<glm::vec4> inputs;
    for (const float u : uniforms) inputs.emplace_back(glm::uintBitsToFloat(offset), glm::uintBitsToFloat(count), u, 0);
    const auto outputs = test::SceneProbe(scene).run("parity/distribution.comp", 0, inputs);
    Parity parity("sampling/distribution", "firstAbove", 0);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const std::uint32_t expected =
            reference::firstAbove(std::span(cdf).subspan(offset, count), double(uniforms[i]));
        EXPECT_TRUE(parity.equal(glm::floatBitsToUint(outputs[i].x), expected)) << "u = " << uniforms[i];
    }
}

TEST(DistributionParity, FindsTheSameEntryAtAndBetweenTheSteps) {
    for (const std::uint32_t count : {1u, 2u, 3u, 255u, 256u, 257u}) {
        std::vector<float> weights(count);
        Stress stress(count);
        for (float& weight : weights) weight = stress.word() % 3 == 0 ? 0.0f : stress.magnitude(1e-6f, 1);
        weights.back() = 1;
        std::vector<float> cdf(7, 0.5f);  // of a light before
        const std::vector<float> own = runningFractions<double>(weights);
        cdf.insert(cdf.end(), own.begin(), own.end());
        expectSameEntries(cdf, 7, count);
    }
}

// H44: a large table. Summed in float, its steps are so far off that whole entries become unreachable.
TEST(DistributionParity, FindsTheSameEntryOfALargeTableH44) {
    std::vector<float> weights(1u << 22);
    Stress stress(10);
    for (float& weight : weights) weight = stress.between(0, 1);
    const std::vector<float> exact = runningFractions<double>(weights), naive = runningFractions<float>(weights);
    expectSameEntries(exact, 0, std::uint32_t(exact.size()));
    test::ErrorMeter error;
    for (std::size_t i = 0; i < exact.size(); ++i) error.add(naive[i], exact[i], 1);
    EXPECT_GT(error.worst(), 2 * (1 << 24) / double(exact.size()));  // steps off by two average entries
}

TEST(DistributionParity, AliasTablesHaveTheSameOutcomeForEveryWord) {
    for (const std::uint32_t count : {1u, 2u, 3u, 255u, 1000u}) {
        std::vector<double> weights(count);
        Stress stress(count);
        for (double& weight : weights) weight = stress.word() % 3 == 0 ? 0.0 : stress.magnitude(1e-6f, 1);
        weights.back() = 1;
        const AliasTable table = buildAliasTable(weights);
        CompiledScene scene;
        scene.aliasTable.assign(5, glm::uvec2(0));  // of a table before
        scene.aliasTable.insert(scene.aliasTable.end(), table.entries.begin(), table.entries.end());
        std::vector<glm::vec4> inputs;
        for (int i = 0; i < 20'000; ++i)
            inputs.emplace_back(glm::uintBitsToFloat(5), glm::uintBitsToFloat(count),
                                glm::uintBitsToFloat(i == 0   ? 0u
                                                     : i == 1 ? 0xffffffffu
                                                              : stress.word()),
                                0);
        const auto outputs = test::SceneProbe(scene).run("parity/distribution.comp", 1, inputs);
        Parity parity("sampling/distribution", "sampleAlias", 0);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const std::uint32_t expected = reference::sampleAlias(table.entries, glm::floatBitsToUint(inputs[i].z));
            EXPECT_TRUE(parity.equal(glm::floatBitsToUint(outputs[i].x), expected)) << "count " << count;
        }
    }
}

}  // namespace
}  // namespace parhelion
