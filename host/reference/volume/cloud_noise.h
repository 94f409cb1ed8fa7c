#pragma once

#include "reference/sampling/sampler.h"
#include "shared/cloud_types.h"

namespace parhelion::reference {

/// Three uniforms of a lattice cell.
template <typename Real>
Vec3<Real> cellUniforms(const glm::ivec3& cell, std::uint32_t seed, std::uint32_t stream) {
    const glm::uvec4 word = pcg4d(glm::uvec4(glm::uvec3(cell), seed + stream * 0x9e3779b9u));
    return {toUniform<Real>(word.x), toUniform<Real>(word.y), toUniform<Real>(word.z)};
}

template <typename Real>
Vec3<Real> lerpPrecisely(const Vec3<Real>& a, const Vec3<Real>& b, Real t) {
    return a + (b - a) * t;
}

/// Three independent value noises at x (in lattice cells), in [0, 1] up to rounding; twice differentiable.
///
/// Source: Perlin 2002, "Improving Noise", for the fade 6 f^5 - 15 f^4 + 10 f^3.
template <typename Real>
Vec3<Real> valueNoise(const Vec3<Real>& x, std::uint32_t seed, std::uint32_t stream) {
    const Vec3<Real> base = glm::floor(x), f = x - base;
    const glm::ivec3 cell(base);
    const Vec3<Real> fade = f * f * f * (f * (f * Real(6) - Real(15)) + Real(10));
    const auto corner = [&](int dx, int dy, int dz) {
        return cellUniforms<Real>(cell + glm::ivec3(dx, dy, dz), seed, stream);
    };
    const auto edge = [&](int dy, int dz) { return lerpPrecisely(corner(0, dy, dz), corner(1, dy, dz), fade.x); };
    const auto face = [&](int dz) { return lerpPrecisely(edge(0, dz), edge(1, dz), fade.y); };
    return lerpPrecisely(face(0), face(1), fade.z);
}

/// Fractal sum of three octaves of valueNoise, amplitudes 4/7, 2/7, 1/7: in [0, 1], mean 1/2.
template <typename Real>
Vec3<Real> fbm(const Vec3<Real>& x, std::uint32_t seed, std::uint32_t stream) {
    const Vec3<Real> sum = valueNoise(x, seed, stream) + valueNoise(x * Real(2), seed, stream + 1) * Real(0.5) +
                           valueNoise(x * Real(4), seed, stream + 2) * Real(0.25);
    return glm::clamp(sum * (Real(4) / Real(7)), Real(0), Real(1));
}

/// Squared distance to the nearest of random points, one in each lattice cell; limited to 1. In [0, 1].
///
/// Within distance 1 the 27 cells around x hold every point, so that the result is exact and continuous.
/// Source: Worley 1996, "A Cellular Texture Basis Function". Squared: its bumps are round, without a cusp.
template <typename Real>
Real worley(const Vec3<Real>& x, std::uint32_t seed, std::uint32_t stream) {
    const Vec3<Real> base = glm::floor(x), f = x - base;
    Real nearest = 1;
    for (int dz = -1; dz <= 1; ++dz) {
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
                const glm::ivec3 offset(dx, dy, dz);
                const Vec3<Real> point =
                    Vec3<Real>(offset) + cellUniforms<Real>(glm::ivec3(base) + offset, seed, stream);
                const Vec3<Real> v = point - f;
                nearest = std::min(nearest, (v.x * v.x + v.y * v.y) + v.z * v.z);
            }
        }
    }
    return nearest;
}

}  // namespace parhelion::reference
