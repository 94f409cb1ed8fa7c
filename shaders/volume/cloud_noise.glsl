// Noise of procedural clouds: the same bits on every device (shaders/README.md, Procedural cloud).
// Only + - * floor and integers, each result rounded on its own: everything is `precise`, nothing calls mix or dot.
#ifndef VOLUME_CLOUD_NOISE_GLSL
#define VOLUME_CLOUD_NOISE_GLSL

#include "sampling/sampler.glsl"
#include "shared/cloud_types.h"

// Three uniforms of a lattice cell.
vec3 cellUniforms(ivec3 cell, uint seed, uint stream) {
    uvec4 word = pcg4d(uvec4(uvec3(cell), seed + stream * 0x9e3779b9u));
    return vec3(toUniform(word.x), toUniform(word.y), toUniform(word.z));
}

vec3 lerpPrecisely(vec3 a, vec3 b, float t) {
    precise vec3 value = a + (b - a) * t;
    return value;
}

// Three independent value noises with a quintic fade, in [0, 1] up to rounding.
vec3 valueNoise(vec3 x, uint seed, uint stream) {
    vec3 base = floor(x);
    precise vec3 f = x - base;
    precise vec3 t = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    ivec3 i = ivec3(base);
    vec3 x00 = lerpPrecisely(cellUniforms(i, seed, stream), cellUniforms(i + ivec3(1, 0, 0), seed, stream), t.x);
    vec3 x10 = lerpPrecisely(cellUniforms(i + ivec3(0, 1, 0), seed, stream),
                             cellUniforms(i + ivec3(1, 1, 0), seed, stream), t.x);
    vec3 x01 = lerpPrecisely(cellUniforms(i + ivec3(0, 0, 1), seed, stream),
                             cellUniforms(i + ivec3(1, 0, 1), seed, stream), t.x);
    vec3 x11 = lerpPrecisely(cellUniforms(i + ivec3(0, 1, 1), seed, stream), cellUniforms(i + 1, seed, stream), t.x);
    return lerpPrecisely(lerpPrecisely(x00, x10, t.y), lerpPrecisely(x01, x11, t.y), t.z);
}

// Three octaves, in [0, 1].
vec3 fbm(vec3 x, uint seed, uint stream) {
    precise vec3 sum = vec3(0.0);
    float amplitude = 1.0, frequency = 1.0;  // powers of two: their products are exact
    for (uint octave = 0u; octave < 3u; ++octave) {
        sum = sum + amplitude * valueNoise(x * frequency, seed, stream + octave);
        amplitude *= 0.5;
        frequency *= 2.0;
    }
    precise vec3 mean = sum * 0.5714285714;  // 4 / 7
    return clamp(mean, 0.0, 1.0);
}

// Squared distance to the nearest of the points, one in each cell; at most 1, so that the 27 cells around hold it.
float worley(vec3 x, uint seed, uint stream) {
    vec3 base = floor(x);
    precise vec3 f = x - base;
    float nearest = 1.0;
    for (int i = 0; i < 27; ++i) {
        ivec3 offset = ivec3(i % 3, i / 3 % 3, i / 9) - 1;
        precise vec3 d = (vec3(offset) + cellUniforms(ivec3(base) + offset, seed, stream)) - f;
        precise float square = (d.x * d.x + d.y * d.y) + d.z * d.z;
        nearest = min(nearest, square);
    }
    return nearest;
}

#endif
