// Inversion of tabulated cumulative distributions, in integers (README, "Distributions").
#ifndef SAMPLING_DISTRIBUTION_GLSL
#define SAMPLING_DISTRIBUTION_GLSL

#include "core/scene.glsl"

// Turns of a search: tables have fewer than 2^27 entries. Callers add one more to their loop-back tests.
const uint kSearchSteps = 27u;

// What a word chooses, and where in it.
struct Choice {
    uint entry;
    float offset;  // in [0, 1)
    float left;    // 1 - offset, with its own digits
};

Choice invertDistribution(uint first, uint count, uint word, float fill) {
    uint bucket, rest;
    umulExtended(word, count, bucket, rest);
    int at = int(first + bucket);
    uint low = texelFetch(distributionTexels, at).y, high = texelFetch(distributionTexels, at + 1).y;
    for (uint i = 0u; i < kSearchSteps && low < high; ++i) {
        uint middle = (low + high + 1u) / 2u;
        bool reached = texelFetch(distributionTexels, int(first + middle)).x <= word;
        low = reached ? middle : low;
        high = reached ? high : middle - 1u;
    }
    at = int(first + low);
    uint edge = texelFetch(distributionTexels, at).x, next = texelFetch(distributionTexels, at + 1).x;
    float width = float(next - edge - 1u) + 1.0;  // 2^32 is stored as 0
    return Choice(low, min((float(word - edge) + fill) / width, 0.99999994), (float(next - word - 1u) + (1.0 - fill)) / width);
}

// Quotient and remainder of high * 2^32 + low by a divisor above high, at least 2^31 (Moeller and Granlund 2011, "Improved
// Division by Invariant Integers", algorithm 4). reciprocal = floor((2^64 - 1) / divisor) - 2^32.
uvec2 divideWide(uint high, uint low, uint divisor, uint reciprocal) {
    uint quotient, rest;
    umulExtended(reciprocal, high, quotient, rest);
    rest += low;
    quotient += high + (rest < low ? 2u : 1u);
    uint remainder = low - quotient * divisor;
    bool over = remainder > rest;
    quotient -= over ? 1u : 0u;
    remainder += over ? divisor : 0u;
    bool under = remainder >= divisor;
    return uvec2(quotient + (under ? 1u : 0u), remainder - (under ? divisor : 0u));
}

// The words with which what was chosen goes on choosing. Words.x lies in [below, below + width); width 0: all words.
uvec2 zoomWord(uvec2 words, uint below, uint width, uint reciprocal) {
    uint shift = uint(31 - findMSB(max(width, 1u)));
    uint divisor = max(width, 1u) << shift;  // the remainder comes out shifted as well: its share of the divisor is right
    uint spill = shift == 0u ? 0u : words.y >> (32u - shift);
    uvec2 first = divideWide((words.x - below) << shift | spill, words.y << shift, divisor, reciprocal);
    uvec2 second = divideWide(first.y, 0u, divisor, reciprocal);
    return width == 0u ? words : uvec2(first.x, second.x);
}

#endif
