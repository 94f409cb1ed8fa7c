#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "reference/core/frame.h"
#include "reference/sampling/distribution.h"
#include "reference/sampling/mis.h"
#include "reference/sampling/sampler.h"
#include "reference/sampling/warp.h"

namespace parhelion::reference {
namespace {

constexpr std::uint32_t kAllOnes = 0xffffffffu;

TEST(ReferenceSampler, UniformsStayBelowOne) {
    EXPECT_EQ(toUniform<float>(kAllOnes), 1.0f - 0x1p-24f);
    EXPECT_EQ(toUniform<double>(kAllOnes), 1.0 - 0x1p-24);
    EXPECT_EQ(toUniform<float>(255u), 0.0f);
}

TEST(ReferenceSampler, SpareBitsAndUniformTogetherUseEveryBitOnce) {
    const std::uint32_t spare = spareBits(0xabcdef12u, 0x12345634u, 0xffffff56u);
    EXPECT_EQ(spare, 0x123456u);
}

TEST(ReferenceSampler, CornerOffsetsReadTheBitsThatAcceptAndExponentialLeave) {
    const glm::dvec3 offsets = cornerOffsets<double>({0x000000c0u, 0x80004000u, 0x00000010u, 0u});
    EXPECT_EQ(offsets, glm::dvec3(0x8000, 0x4000, 0xc010) * 0x1p-16);
}

// H32, H33: the extremes of 48 bits. The smallest v is 0.5 * 2^-48, so the longest flight is 49 ln 2.
template <typename Real>
void expectExponentialRange() {
    const Real longest = exponential<Real>(kAllOnes, 0xffffffu);
    EXPECT_NEAR(longest, 49 * std::log(2.0), 1e-5);  // a rounding of the result, 34: 2e-6
    const Real shortest = exponential<Real>(0u, 0u);
    EXPECT_GE(shortest, Real(0));
    EXPECT_LE(shortest, Real(0x1p-24));
}

TEST(ReferenceSampler, ExponentialsAreFiniteAtBothEnds) {
    expectExponentialRange<float>();
    expectExponentialRange<double>();
}

TEST(ReferenceSampler, ExponentialsInFloatFollowThoseInDouble) {
    // The float v has 4 roundings of 2^-24; log turns a relative error into an absolute one, then rounds itself.
    glm::uvec4 words{1, 2, 3, 4};
    for (int i = 0; i < 100000; ++i) {
        words = pcg4d(words);
        const double exact = exponential<double>(words.x, words.y >> 8);
        EXPECT_NEAR(exponential<float>(words.x, words.y >> 8), exact, 6 * 0x1p-24 * (1 + exact));
    }
}

TEST(ReferenceSampler, ExponentialsHaveTheMomentsOfTheirDistribution) {
    constexpr int kCount = 1000000;
    double sum = 0, sumSquares = 0;
    int beyond5 = 0;
    glm::uvec4 words{5, 6, 7, 8};
    for (int i = 0; i < kCount; ++i) {
        words = pcg4d(words);
        const double e = exponential<double>(words.x, words.y >> 8);
        sum += e;
        sumSquares += e * e;
        beyond5 += e > 5;
    }
    // Deviations of the sample means of e (1) and e^2 (sqrt 20), and of the share beyond 5; |z| < 6.1.
    EXPECT_NEAR(sum / kCount, 1.0, 6.1e-3);
    EXPECT_NEAR(sumSquares / kCount, 2.0, 6.1e-3 * std::sqrt(20.0));
    EXPECT_NEAR(beyond5, kCount * std::exp(-5.0), 6.1 * std::sqrt(kCount * std::exp(-5.0)));
}

TEST(ReferenceSampler, KeysDifferAcrossThe32BitBoundaryOfTheSampleIndex) {  // H76
    EXPECT_NE(pathKey(7, 0, 0, 0), pathKey(7, 0, 1, 0));
    EXPECT_NE(pathKey(7, 0, 0, 0), pathKey(8, 0, 0, 0));
    EXPECT_NE(pathKey(7, 0, 0, 0), pathKey(7, 0, 0, 1));
}

TEST(ReferenceSampler, NeighbouringPixelsAreUncorrelated) {  // H75
    constexpr int kCount = 200000;
    double product = 0;
    for (int i = 0; i < kCount; ++i) {
        const auto first = [&](int pixel) {
            return toUniform<double>(draw(pathKey(std::uint32_t(pixel), 0, 0, 0), 1, 1).x) - 0.5;
        };
        product += 12 * first(i) * first(i + 1);
    }
    // The product of two independent standardised uniforms has mean 0 and deviation 1.
    EXPECT_LT(std::abs(product / kCount), 5 / std::sqrt(double(kCount)));
}

TEST(ReferenceFrame, IsOrthonormalForEveryNormalAndBothPoles) {  // H10
    const auto check = [](glm::vec3 n) {
        const Frame<float> f = frameFromNormal(n);
        // Duff et al. bound the error by 1.6e-7; the dot products here round three times more.
        EXPECT_NEAR(glm::dot(f.tangent, f.bitangent), 0, 5e-7);
        EXPECT_NEAR(glm::dot(f.tangent, n), 0, 5e-7);
        EXPECT_NEAR(glm::dot(f.bitangent, n), 0, 5e-7);
        EXPECT_NEAR(glm::length(f.tangent), 1, 5e-7);
        EXPECT_NEAR(glm::length(f.bitangent), 1, 5e-7);
        EXPECT_GT(glm::dot(glm::cross(f.tangent, f.bitangent), n), 0.999f);
    };
    check({0, 0, 1});
    check({0, 0, -1});
    check(glm::normalize(glm::vec3(1e-4f, 1e-4f, -1)));
    glm::uvec4 words{1, 1, 1, 1};
    for (int i = 0; i < 10000; ++i) {
        words = pcg4d(words);
        check(glm::normalize(uniformSphere(glm::vec2(toUniform<float>(words.x), toUniform<float>(words.y)))));
    }
}

TEST(ReferenceWarp, CosineHemisphereHasTheMomentsOfItsDensity) {
    constexpr int kSide = 512;
    double cosine = 0, square = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
        const glm::dvec3 d = cosineHemisphere(glm::dvec2(i % kSide + 0.5, i / kSide + 0.5) / double(kSide));
        EXPECT_NEAR(glm::dot(d, d), 1, 1e-14);
        cosine += d.z;
        square += d.z * d.z;
    }
    // Midpoint rule on 512 points: sqrt(1 - u) is off by < (1/512)^1.5 / 3, the rest by less.
    EXPECT_NEAR(cosine / (kSide * kSide), 2.0 / 3, 3e-5);
    EXPECT_NEAR(square / (kSide * kSide), 0.5, 1e-6);
}

TEST(ReferenceWarp, UniformSphereHasTheMomentsOfItsDensity) {
    constexpr int kSide = 256;
    glm::dvec3 sum(0), squares(0);
    for (int i = 0; i < kSide * kSide; ++i) {
        const glm::dvec3 d = uniformSphere(glm::dvec2(i % kSide + 0.5, i / kSide + 0.5) / double(kSide));
        EXPECT_NEAR(glm::dot(d, d), 1, 1e-14);
        sum += d;
        squares += d * d;
    }
    // z^2 is quadratic in u: the midpoint rule is off by (1/256)^2 / 6 at most; x and y share the rest evenly.
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(sum[axis] / (kSide * kSide), 0, 1e-12);
        EXPECT_NEAR(squares[axis] / (kSide * kSide), 1.0 / 3, 6e-6);
    }
}

TEST(ReferenceWarp, NarrowConesKeepTheirWidthInFloat) {  // H62: the sun's disc
    const float oneMinusCos = 1.08e-5f;
    const glm::vec3 rim = uniformCone(glm::vec2(1 - 0x1p-24f, 0.0f), oneMinusCos);
    const double sine = std::sqrt(double(oneMinusCos) * (2 - double(oneMinusCos)));
    EXPECT_NEAR(std::hypot(rim.x, rim.y) / sine, 1.0, 1e-6);
    EXPECT_EQ(uniformCone(glm::vec2(0.0f, 0.3f), oneMinusCos).z, 1.0f);
}

TEST(ReferenceWarp, TrianglePointsAreUniform) {
    constexpr int kSide = 512;
    glm::dvec3 sum(0);
    for (int i = 0; i < kSide * kSide; ++i)
        sum += uniformTriangle(glm::dvec2(i % kSide + 0.5, i / kSide + 0.5) / double(kSide));
    // Centroid; sqrt(u) is off as above.
    for (int corner = 0; corner < 3; ++corner) EXPECT_NEAR(sum[corner] / (kSide * kSide), 1.0 / 3, 3e-5);
}

TEST(ReferenceDistribution, FindsEntriesAndPlacesWithinThem) {
    // A quarter, nothing, a half, a quarter, nothing; the last that has words is number 3.
    const std::array<glm::uvec2, 6> table{{{0, 0}, {1u << 30, 0}, {1u << 30, 2}, {3u << 30, 2}, {0, 3}, {0, 3}}};
    const auto expectPlace = [&](std::uint32_t word, double fill, std::uint32_t entry, double offset) {
        const auto choice = invertDistribution(std::span<const glm::uvec2>(table), word, fill);
        EXPECT_EQ(choice.entry, entry) << word;
        EXPECT_EQ(choice.offset, offset) << word;
    };
    expectPlace(0, 0, 0, 0);
    expectPlace((1u << 30) - 1, 0.5, 0, 1 - 0x1p-31);
    expectPlace(1u << 30, 0, 2, 0);
    expectPlace(1u << 31, 0, 2, 0.5);
    expectPlace(0xffffffffu, 0.5, 3, 1 - 0x1p-31);
    EXPECT_LT(invertDistribution<float>(table, 0xffffffffu, 0.999f).offset, 1.0f);
}

TEST(ReferenceDistribution, ZoomedWordsAreUniformAndRiseWithTheWord) {
    // Of 3 words, from 5 on, and 2^32 fills: each third of the fills more is a third of a word more.
    EXPECT_EQ(zoomWord({5, 0}, 5, 3), glm::uvec2(0, 0));
    EXPECT_EQ(zoomWord({6, 0}, 5, 3), glm::uvec2(0x55555555u, 0x55555555u));
    EXPECT_EQ(zoomWord({7, 0xffffffffu}, 5, 3), glm::uvec2(0xffffffffu, 0xaaaaaaaau));
    EXPECT_EQ(zoomWord({7, 9}, 0, 0), glm::uvec2(7, 9));
}

TEST(ReferenceMis, WeightsOfTwoStrategiesSumToOne) {  // H69
    for (const float a : {1e-30f, 1e-3f, 1.0f, 1e25f})
        for (const float b : {1e-30f, 2e-3f, 1.0f, 1e25f})
            EXPECT_NEAR(balanceHeuristic(a, b) + balanceHeuristic(b, a), 1, 1e-6);
}

TEST(ReferenceMis, ExtremesAreFinite) {  // H69, H70
    constexpr float kInf = kInfinity<float>;
    EXPECT_EQ(balanceHeuristic(0.0f, 0.0f), 0.0f);
    EXPECT_EQ(balanceHeuristic(0.0f, 1.0f), 0.0f);
    EXPECT_EQ(balanceHeuristic(1.0f, 0.0f), 1.0f);
    EXPECT_EQ(balanceHeuristic(kInf, 1.0f), 1.0f);
    EXPECT_EQ(balanceHeuristic(1.0f, kInf), 0.0f);
    EXPECT_EQ(balanceHeuristic(kInf, kInf), 1.0f);
    EXPECT_EQ(balanceHeuristic(1e-38f, 1e38f), 0.0f);
}

}  // namespace
}  // namespace parhelion::reference
