#pragma once

#include <cmath>
#include <cstdint>

#include "reference/core/math.h"

namespace parhelion::reference {

/// Hash of four words into four.
///
/// Source: Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", JCGT 9(3).
inline glm::uvec4 pcg4d(glm::uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

/// What a path's draws are keyed by. `pixel` counts over the whole film, row by row.
inline glm::uvec2 pathKey(std::uint32_t pixel, std::uint32_t sampleLow, std::uint32_t sampleHigh, std::uint32_t seed) {
    const glm::uvec4 hashed = pcg4d({pixel, sampleLow, sampleHigh, seed});
    return {hashed.x, hashed.y};
}

/// Four random words for one purpose (kDraw*) at one vertex.
inline glm::uvec4 draw(glm::uvec2 key, std::uint32_t vertex, std::uint32_t purpose) {
    return pcg4d({key.x, key.y, vertex, purpose});
}

/// What a pixel's scrambled points are keyed by; all its samples share it.
inline glm::uvec2 pixelKey(std::uint32_t pixel, std::uint32_t sampleHigh, std::uint32_t seed) {
    const glm::uvec4 hashed = pcg4d({pixel, 0, sampleHigh, seed});
    return {hashed.z, hashed.w};
}

/// Hash whose every bit depends on that bit and lower ones: a random permutation of each node of the digit tree.
///
/// Source: Laine and Karras 2011, "Stratified Sampling for Stochastic Transparency"; constants: Vegdahl 2021, "Building
/// a Better LK Hash".
inline std::uint32_t permuteDigits(std::uint32_t x, std::uint32_t seed) {
    x = x ^ (x * 0x3d20adeau);
    x = (x + seed) * ((seed >> 16) | 1u);
    x = x ^ (x * 0x05526c56u);
    return x ^ (x * 0x53a22864u);
}

/// Reference only: an instruction in GLSL.
inline std::uint32_t reverseBits(std::uint32_t x) {
    std::uint32_t reversed = 0;
    for (int bit = 0; bit < 32; ++bit) reversed |= (x >> bit & 1u) << (31 - bit);
    return reversed;
}

/// Second component of Sobol' point `index`, lowest bit first, from its direction numbers v_0 = 2^31,
/// v_k+1 = v_k ^ (v_k >> 1).
///
/// Source: Sobol' 1967; Bratley and Fox 1988, algorithm 659.
inline std::uint32_t sobolDigits(std::uint32_t index) {
    std::uint32_t value = 0;
    std::uint32_t direction = 0x80000000u;
    for (int bit = 0; bit < 32; ++bit, direction ^= direction >> 1)
        if (index >> bit & 1u) value ^= direction;
    return reverseBits(value);
}

/// One Owen-scrambled point of the (0, 2)-sequence of Sobol', of a shuffled index.
///
/// Source: Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4).
inline glm::uvec2 sobolPair(std::uint32_t reversedIndex, glm::uvec2 seed) {
    const std::uint32_t index = reverseBits(permuteDigits(reversedIndex, seed.x ^ seed.y));
    return {reverseBits(permuteDigits(index, seed.x)), reverseBits(permuteDigits(sobolDigits(index), seed.y))};
}

/// What a path draws from.
struct Stream {
    glm::uvec2 key;  ///< pathKey
    glm::uvec2 pixelKey;
    std::uint32_t reversedIndex;  ///< low word of the sample's index, its bits reversed
};

inline Stream streamOf(std::uint32_t pixel, std::uint32_t sampleLow, std::uint32_t sampleHigh, std::uint32_t seed) {
    return {pathKey(pixel, sampleLow, sampleHigh, seed), pixelKey(pixel, sampleHigh, seed), reverseBits(sampleLow)};
}

/// As draw; where `sobol`, each of (x, y) and (z, w) is stratified over the pixel's samples.
inline glm::uvec4 drawStratified(const Stream& stream, bool sobol, std::uint32_t vertex, std::uint32_t purpose) {
    if (!sobol) return draw(stream.key, vertex, purpose);
    const glm::uvec4 seeds = draw(stream.pixelKey, vertex, purpose);
    return {sobolPair(stream.reversedIndex, {seeds.x, seeds.y}), sobolPair(stream.reversedIndex, {seeds.z, seeds.w})};
}

/// Uniform in [0, 1), a multiple of 2^-24.
template <typename Real>
Real toUniform(std::uint32_t word) {
    return Real(word >> 8) * Real(0x1p-24);
}

/// What the third word of a light draw lends the first two: a uniform number of 16 digits, amid its step, for each.
template <typename Real>
Vec2<Real> fillDigits(std::uint32_t word) {
    const auto digits = [](std::uint32_t bits) { return Real(2 * bits + 1) * Real(0x1p-17); };
    return {digits(word / 65536u), digits(word % 65536u)};
}

/// The 24 bits of three words that toUniform leaves.
inline std::uint32_t spareBits(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return (x & 255u) << 16 | (y & 255u) << 8 | (z & 255u);
}

/// Unit-mean exponential from 48 bits: always finite, up to 34 mean free paths.
template <typename Real>
Real exponential(std::uint32_t hi, std::uint32_t lo24) {
    // 1 - (lo24 + 0.5) 2^-24 from the complement of the integer: exact where it is small.
    const Real fraction = (Real(0xffffffu - lo24) + Real(0.5)) * Real(0x1p-24);
    const Real complement = (Real(hi >> 8) + (Real(lo24) + Real(0.5)) * Real(0x1p-24)) * Real(0x1p-24);
    if (complement < Real(0x1p-10)) return -std::log1p(-complement);  // thin media need its digits (H13)
    return -logPositive((Real(0xffffffu - (hi >> 8)) + fraction) * Real(0x1p-24));
}

/// Three 16-bit uniforms for the stochastic density lookup, from a tracking draw.
template <typename Real>
Vec3<Real> cornerOffsets(const glm::uvec4& trackingDraw) {
    const std::uint32_t z = (trackingDraw.x & 255u) << 8 | (trackingDraw.z & 255u);
    return Vec3<Real>(Real(trackingDraw.y >> 16), Real(trackingDraw.y & 0xffffu), Real(z)) * Real(0x1p-16);
}

}  // namespace parhelion::reference
