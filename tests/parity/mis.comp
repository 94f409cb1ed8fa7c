#version 460
#include "../support/probe.glsl"
#include "sampling/mis.glsl"

void probeItem() {
    vec4 pdf = probeInput(0u);
    probeOutput(0u, vec4(balanceHeuristic(pdf.x, pdf.y), balanceHeuristic(pdf.y, pdf.x),
                         emissionWeight(pdf.x, pdf.y), 0.0));
}
