#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "shared/path_types.h"
#include "sampling/sampler.glsl"

void probeItem() {
    uvec4 word = floatBitsToUint(probeInput(0u));
    switch (probeFunction) {
        case 0u:
            probeOutput(0u, uintBitsToFloat(pcg4d(word)));
            probeOutput(1u, uintBitsToFloat(uvec4(pathKey(word.x, word.y, word.z, word.w), spareBits(word.x, word.y, word.z), 0u)));
            probeOutput(2u, uintBitsToFloat(draw(word.xy, word.z, word.w)));
            break;
        case 2u: {
            Stream stream = streamOf(word.x, word.y, word.z, word.w);
            probeOutput(0u, uintBitsToFloat(uvec4(permuteDigits(word.x, word.y), sobolDigits(word.x), sobolPair(word.x, word.yz))));
            probeOutput(1u, uintBitsToFloat(uvec4(stream.key, stream.pixelKey)));
            probeOutput(2u, uintBitsToFloat(uvec4(stream.reversedIndex, pixelKey(word.x, word.z, word.w), 0u)));
            probeOutput(3u, uintBitsToFloat(drawStratified(stream, word.y % 5u, kDrawScatter)));
            break;
        }
        case 1u:
            probeOutput(0u, vec4(cornerOffsets(word), toUniform(word.x)));
            probeOutput(1u, vec4(exponential(word.x, word.y & 0xffffffu), fillDigits(word.x), 0.0));
            break;
    }
}
