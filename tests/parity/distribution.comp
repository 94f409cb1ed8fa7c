#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "sampling/distribution.glsl"

void probeItem() {
    uvec2 range = floatBitsToUint(probeInput(0u).xy);
    probeOutput(0u, uintBitsToFloat(uvec4(firstAbove(range.x, range.y, probeInput(0u).z))));
}
