// Inversion of tabulated cumulative distributions.
#ifndef SAMPLING_DISTRIBUTION_GLSL
#define SAMPLING_DISTRIBUTION_GLSL

#include "core/scene.glsl"

// Loop-back tests a search may cost: callers add them to their budget.
const uint kSearchSteps = 24u;

// Index of the first of `count` entries of lightTriangleCdf from `offset` on that is above u in
// [0, 1). The last entry is exactly 1, so there is one. count < 2^24.
uint firstAbove(uint offset, uint count, float u) {
    uint low = 0u, high = count - 1u;
    for (uint i = 0u; i < kSearchSteps; ++i) {
        uint middle = (low + high) / 2u;
        bool above = texelFetch(lightCdfTexels, int(offset + middle)).x > u;
        high = above ? middle : high;
        low = above ? low : min(middle + 1u, high);
    }
    return high;
}

// Outcome of the alias table of `count` entries from `offset` on (host/compile/alias_table.h) for a random word.
uint sampleAlias(uint offset, uint count, uint word) {
    uint bucket, rest;
    umulExtended(word, count, bucket, rest);
    uvec2 entry = texelFetch(aliasTexels, int(offset + bucket)).xy;
    return rest < entry.x ? bucket : entry.y;
}

#endif
