#version 460
#include "../support/probe.glsl"
#include "sampling/sampler.glsl"

void probeItem() {
    uvec4 word = floatBitsToUint(probeInput(0u));
    switch (probeFunction) {
        case 0u:
            probeOutput(0u, uintBitsToFloat(pcg4d(word)));
            probeOutput(1u, uintBitsToFloat(uvec4(pathKey(word.x, word.y, word.z, word.w), spareBits(word.x, word.y, word.z), 0u)));
            probeOutput(2u, uintBitsToFloat(draw(word.xy, word.z, word.w)));
            break;
        case 1u:
            probeOutput(0u, vec4(cornerOffsets(word), toUniform(word.x)));
            probeOutput(1u, vec4(exponential(word.x, word.y & 0xffffffu), 0.0, 0.0, 0.0));
            break;
    }
}
