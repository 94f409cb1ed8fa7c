// shaders/sampling/sampler.glsl: integers to the bit, numbers against double precision.
#include "reference/sampling/sampler.h"

#include <gtest/gtest.h>

#include <array>

#include "shared/path_types.h"
#include "support/gpu_fixture.h"
#include "support/parity_report.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::ErrorMeter;
using test::Parity;
using test::Stress;

const char* const kShader = "parity/sampler.comp";
enum Function : std::uint32_t { kHashes, kNumbers, kPoints };

std::vector<glm::uvec4> words() {
    std::vector<glm::uvec4> words;
    for (const std::uint32_t a : {0u, 1u, 0xffu, 0x100u, 0xffffffu, 0x1000000u, 0x80000000u, 0xffffff00u, 0xffffffffu})
        for (const std::uint32_t b : {0u, 1u, 0xffffffu, 0xffffffffu})
            words.emplace_back(a, b, ~a, shared::kDrawShadow | b);
    Stress stress(7);
    for (int i = 0; i < 20'000; ++i) words.emplace_back(stress.word(), stress.word(), stress.word(), stress.word());
    return words;
}

std::vector<glm::vec4> asFloats(const std::vector<glm::uvec4>& words) {
    std::vector<glm::vec4> floats;
    for (const glm::uvec4& word : words) floats.push_back(glm::uintBitsToFloat(word));
    return floats;
}

TEST(SamplerParity, HashesAgreeToTheBit) {
    const auto inputs = words();
    const auto outputs = test::probe(kShader, kHashes, asFloats(inputs), 1, 3);
    Parity hash("sampling/sampler", "pcg4d", 0), key("sampling/sampler", "pathKey", 0);
    Parity drawn("sampling/sampler", "draw", 0), spare("sampling/sampler", "spareBits", 0);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::uvec4 w = inputs[i];
        const glm::uvec4 hashed = glm::floatBitsToUint(outputs[3 * i]),
                         other = glm::floatBitsToUint(outputs[3 * i + 1]);
        const glm::uvec4 draw = glm::floatBitsToUint(outputs[3 * i + 2]);
        for (int c = 0; c < 4; ++c) {
            EXPECT_TRUE(hash.equal(hashed[c], reference::pcg4d(w)[c])) << i;
            EXPECT_TRUE(drawn.equal(draw[c], reference::draw(glm::uvec2(w), w.z, w.w)[c])) << i;
        }
        for (int c = 0; c < 2; ++c) EXPECT_TRUE(key.equal(other[c], reference::pathKey(w.x, w.y, w.z, w.w)[c])) << i;
        EXPECT_TRUE(spare.equal(other.z, reference::spareBits(w.x, w.y, w.z))) << i;
    }
}

TEST(SamplerParity, ScrambledPointsAgreeToTheBit) {
    const auto inputs = words();
    const auto outputs = test::probe(kShader, kPoints, asFloats(inputs), 1, 4);
    Parity permuted("sampling/sampler", "permuteDigits", 0), digits("sampling/sampler", "sobolDigits", 0),
        pair("sampling/sampler", "sobolPair", 0), pixel("sampling/sampler", "pixelKey", 0),
        stream("sampling/sampler", "streamOf", 0), drawn("sampling/sampler", "drawStratified", 0);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::uvec4 w = inputs[i];
        glm::uvec4 out[4];
        for (int k = 0; k < 4; ++k) out[k] = glm::floatBitsToUint(outputs[4 * i + k]);
        EXPECT_TRUE(permuted.equal(out[0].x, reference::permuteDigits(w.x, w.y))) << i;
        EXPECT_TRUE(digits.equal(out[0].y, reference::sobolDigits(w.x))) << i;
        const reference::Stream expected = reference::streamOf(w.x, w.y, w.z, w.w);
        for (int c = 0; c < 2; ++c) {
            EXPECT_TRUE(pair.equal(out[0][2 + c], reference::sobolPair(w.x, {w.y, w.z})[c])) << i;
            EXPECT_TRUE(stream.equal(out[1][c], expected.key[c])) << i;
            EXPECT_TRUE(stream.equal(out[1][2 + c], expected.pixelKey[c])) << i;
            EXPECT_TRUE(pixel.equal(out[2][1 + c], reference::pixelKey(w.x, w.z, w.w)[c])) << i;
        }
        EXPECT_TRUE(stream.equal(out[2].x, expected.reversedIndex)) << i;
        const glm::uvec4 points = reference::drawStratified(expected, true, w.y % 5, shared::kDrawScatter);
        for (int c = 0; c < 4; ++c) EXPECT_TRUE(drawn.equal(out[3][c], points[c])) << i;
    }
}

// Outputs of the published function, evaluated with integers of unlimited size and a remainder after each operation.
TEST(SamplerParity, HashIsThePublishedOne) {
    const std::vector<glm::uvec4> inputs{
        {0, 0, 0, 0}, {1, 2, 3, 4}, glm::uvec4(~0u), {0x80000000, 1, 0x10000, 0xdeadbeef}};
    const std::array<glm::uvec4, 4> expected{{{0x0f02f829, 0x2d568769, 0x32b0c43b, 0xd32548ea},
                                              {0x3622cd16, 0xf11471d8, 0xe1109b3f, 0x02b94c2f},
                                              {0x974ed892, 0xc015dc67, 0x9f955760, 0xa1bba208},
                                              {0xabdded8a, 0xc71691fd, 0x965a431f, 0xd8373e3b}}};
    const auto outputs = test::probe(kShader, kHashes, asFloats(inputs), 1, 3);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        EXPECT_EQ(glm::floatBitsToUint(outputs[3 * i]), expected[i]) << i;
        EXPECT_EQ(reference::pcg4d(inputs[i]), expected[i]) << i;
    }
}

TEST(SamplerParity, UniformsAreExactAndBelowOne) {
    const auto inputs = words();
    const auto outputs = test::probe(kShader, kNumbers, asFloats(inputs), 1, 2);
    Parity uniform("sampling/sampler", "toUniform", 0), corner("sampling/sampler", "cornerOffsets", 0),
        fill("sampling/sampler", "fillDigits", 0);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        EXPECT_TRUE(uniform.near(outputs[2 * i].w, reference::toUniform<double>(inputs[i].x))) << i;
        EXPECT_TRUE(corner.near(outputs[2 * i], reference::cornerOffsets<double>(inputs[i]))) << i;
        EXPECT_LT(outputs[2 * i].w, 1.0f);
        const glm::dvec2 digits = reference::fillDigits<double>(inputs[i].x);
        for (int c = 0; c < 2; ++c) EXPECT_TRUE(fill.near(outputs[2 * i + 1][1 + c], digits[c])) << i;
    }
}

// H32: the logarithm of 0; H33: flights beyond what 24 bits reach.
TEST(SamplerParity, ExponentialIsFiniteAndReachesBeyondTwentyFourBitsH32H33) {
    // Sum and the rest it takes: 2 roundings of the logarithm's argument; 1 ulp of the result.
    constexpr double kAllowed = 4;
    std::vector<glm::uvec4> inputs = words();
    Stress stress(8);
    for (int i = 0; i < 1000; ++i) inputs.emplace_back(0xffffff00u | stress.word(), stress.word(), 0, 0);
    const auto outputs = test::probe(kShader, kNumbers, asFloats(inputs), 1, 2);
    Parity parity("sampling/sampler", "exponential", kAllowed);
    ErrorMeter halfStep, twentyFourBits;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const std::uint32_t high = inputs[i].x, low = inputs[i].y & 0xffffffu;
        const double expected = reference::exponential<double>(high, low);
        const double scale = std::max(1.0, expected);
        EXPECT_TRUE(parity.near(outputs[2 * i + 1].x, expected, scale)) << std::hex << high << " " << low;
        EXPECT_GE(outputs[2 * i + 1].x, 0.0f);
        halfStep.add(-std::log(1.0f - (float(high) + 0.5f) * 0x1p-32f), expected, scale);
        twentyFourBits.add(-std::log(1.0f - float(high >> 8) * 0x1p-24f), expected, scale);
    }
    EXPECT_GT(halfStep.worst(), kAllowed);
    EXPECT_GT(twentyFourBits.worst(), kAllowed);
}

}  // namespace
}  // namespace parhelion
