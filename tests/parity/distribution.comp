#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "sampling/distribution.glsl"

void probeItem() {
    uvec4 a = floatBitsToUint(probeInput(0u));
    switch (probeFunction) {
        case 0u: {  // first, count, word; fill
            Choice choice = invertDistribution(a.x, a.y, a.z, probeInput(0u).w);
            probeOutput(0u, vec4(uintBitsToFloat(choice.entry), choice.offset, choice.left, 0.0));
            break;
        }
        case 1u: probeOutput(0u, uintBitsToFloat(uvec4(divideWide(a.x, a.y, a.z, a.w), 0u, 0u))); break;
        case 2u: {  // words, below, width; reciprocal
            uint reciprocal = floatBitsToUint(probeInput(1u).x);
            probeOutput(0u, uintBitsToFloat(uvec4(zoomWord(a.xy, a.z, a.w, reciprocal), 0u, 0u)));
            break;
        }
    }
}
