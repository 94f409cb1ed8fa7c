#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "sampling/distribution.glsl"

void probeItem() {
    uvec2 range = floatBitsToUint(probeInput(0u).xy);
    if (probeFunction == 0u) probeOutput(0u, uintBitsToFloat(uvec4(firstAbove(range.x, range.y, probeInput(0u).z))));
    if (probeFunction == 1u)
        probeOutput(0u, uintBitsToFloat(uvec4(sampleAlias(range.x, range.y, floatBitsToUint(probeInput(0u).z)))));
}
