// Counter-based random numbers: every draw is a pure function of (path, vertex, purpose), so that
// leaving an effect out shifts no other draw. Purposes are named in shared/path_types.h.
// Draws with a fixed number of uses a vertex may be stratified over the samples of a pixel.
#ifndef SAMPLING_SAMPLER_GLSL
#define SAMPLING_SAMPLER_GLSL

#include "core/effects.glsl"
#include "core/math.glsl"

// Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", pcg4d.
uvec4 pcg4d(uvec4 v) {
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

// 64 bits that name a path. sampleLow and sampleHigh are one 64-bit sample index.
uvec2 pathKey(uint pixel, uint sampleLow, uint sampleHigh, uint seed) {
    return pcg4d(uvec4(pixel, sampleLow, sampleHigh, seed)).xy;
}

uvec4 draw(uvec2 key, uint vertex, uint purpose) { return pcg4d(uvec4(key, vertex, purpose)); }

// What names a pixel's scrambled points; all its samples share it.
uvec2 pixelKey(uint pixel, uint sampleHigh, uint seed) { return pcg4d(uvec4(pixel, 0u, sampleHigh, seed)).zw; }

// A random permutation of the tree of binary digits, the lowest bit being the root (Laine and Karras 2011,
// constants of Vegdahl 2021, "Building a Better LK Hash").
uint permuteDigits(uint x, uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    return x ^ (x * 0x53a22864u);
}

// Second component of Sobol' point `index`, lowest bit first: the generator matrix is Pascal's triangle
// modulo 2, a product of five butterflies.
uint sobolDigits(uint index) {
    index ^= (index & 0xaaaaaaaau) >> 1u;
    index ^= (index & 0xccccccccu) >> 2u;
    index ^= (index & 0xf0f0f0f0u) >> 4u;
    index ^= (index & 0xff00ff00u) >> 8u;
    return index ^ (index >> 16u);
}

// One Owen-scrambled Sobol' point (a (0, 2)-sequence) with its index shuffled, so that any two pairs of a path
// are independent and each is stratified over the samples (Burley 2020, "Practical Hash-based Owen Scrambling").
uvec2 sobolPair(uint reversedIndex, uvec2 seed) {
    uint index = bitfieldReverse(permuteDigits(reversedIndex, seed.x ^ seed.y));
    return uvec2(bitfieldReverse(permuteDigits(index, seed.x)), bitfieldReverse(permuteDigits(sobolDigits(index), seed.y)));
}

// What a path draws from.
struct Stream {
    uvec2 key;           // pathKey
    uvec2 pixelKey;
    uint reversedIndex;  // low word of the sample's index, its bits reversed
};

Stream streamOf(uint pixel, uint sampleLow, uint sampleHigh, uint seed) {
    return Stream(pathKey(pixel, sampleLow, sampleHigh, seed), pixelKey(pixel, sampleHigh, seed),
                  bitfieldReverse(sampleLow));
}

// As draw; with the quality `sobol`, (x, y) and (z, w) are each stratified over the pixel's samples.
uvec4 drawStratified(Stream stream, uint vertex, uint purpose) {
    if (!sobol) return draw(stream.key, vertex, purpose);
    uvec4 seeds = draw(stream.pixelKey, vertex, purpose);
    return uvec4(sobolPair(stream.reversedIndex, seeds.xy), sobolPair(stream.reversedIndex, seeds.zw));
}

// In [0, 1): multiples of 2^-24, never 1.
float toUniform(uint word) { return float(word >> 8u) * 5.9604644775390625e-8; }

// What a light draw's z lends its x and y, in (0, 1): 16 digits each (README, "Distributions").
vec2 fillDigits(uint word) { return (vec2(word >> 16u, word & 0xffffu) + 0.5) * 1.52587890625e-5; }

// The 24 bits that toUniform leaves of three words.
uint spareBits(uint x, uint y, uint z) { return (x & 255u) << 16u | (y & 255u) << 8u | (z & 255u); }

// -log of a uniform number of 48 bits, in (0, 33.3]: the first 24 alone would end flights at 16.6.
float exponential(uint high, uint low24) {
    float rest = (float(0xffffffu - low24) + 0.5) * 5.9604644775390625e-8;  // never 0
    float x = (float(high >> 8u) + (float(low24) + 0.5) * 5.9604644775390625e-8) * 5.9604644775390625e-8;
    // -log(1 - x) of a small x by its series, to 2^-31 of itself: 1 - x has no digits left for it (H13).
    float series = x * (1.0 + x * (0.5 + x * 0.33333333));
    float tail = -logPositive((float(0xffffffu - (high >> 8u)) + rest) * 5.9604644775390625e-8);
    return x < 0.0009765625 ? series : tail;
}

// Three 16-bit uniforms for a stochastic grid corner out of a tracking draw.
vec3 cornerOffsets(uvec4 word) {
    uvec3 bits = uvec3(word.y >> 16u, word.y & 0xffffu, (word.x & 255u) << 8u | (word.z & 255u));
    return vec3(bits) * 1.52587890625e-5;
}

#endif
