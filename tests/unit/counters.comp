#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "../support/probe.glsl"
#include "integrator/counters.glsl"

void probeItem() {
    count(kCounterSteps, floatBitsToUint(probeInput(0u).x));
    count(kCounterVertices, 1u);
}
