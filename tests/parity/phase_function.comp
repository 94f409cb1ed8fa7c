#version 460
#include "../support/probe.glsl"
#include "volume/phase_function.glsl"

void probeItem() {
    vec4 a = probeInput(0u);  // g, u, cosine of the pair of directions
    probeOutput(0u, vec4(sampleHenyeyGreenstein(a.x, a.y), 0.0));
    probeOutput(1u, vec4(evalHenyeyGreenstein(a.x, probeInput(1u).xyz, probeInput(2u).xyz), 0.0, 0.0, 0.0));
}
