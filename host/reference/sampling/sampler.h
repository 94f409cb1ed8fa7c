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

/// Uniform in [0, 1), a multiple of 2^-24.
template <typename Real>
Real toUniform(std::uint32_t word) {
    return Real(word >> 8) * Real(0x1p-24);
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
    if (complement < Real(0x1p-10)) return -std::log1p(-complement);  // thin media need its digits (numerics H13)
    return -logPositive((Real(0xffffffu - (hi >> 8)) + fraction) * Real(0x1p-24));
}

/// Three 16-bit uniforms for the stochastic density lookup, from a tracking draw.
template <typename Real>
Vec3<Real> cornerOffsets(const glm::uvec4& trackingDraw) {
    const std::uint32_t z = (trackingDraw.x & 255u) << 8 | (trackingDraw.z & 255u);
    return Vec3<Real>(Real(trackingDraw.y >> 16), Real(trackingDraw.y & 0xffffu), Real(z)) * Real(0x1p-16);
}

}  // namespace parhelion::reference
