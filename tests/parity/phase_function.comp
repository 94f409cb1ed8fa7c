#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "volume/phase_function.glsl"

// Rows: (u, g or medium, interval, high half of the word), (wo, low half of the word), (wi, 0); the word that samples a
// whole function is that of u.
void probeItem() {
    vec4 a = probeInput(0u), b = probeInput(1u);
    vec3 wo = b.xyz, wi = probeInput(2u).xyz;
    uint word = uint(a.w) << 16u | uint(b.w);
    Medium medium = scene.media[uint(max(a.y, 0.0))];
    switch (probeFunction) {
        case 0u:
            probeOutput(0u, vec4(sampleHenyeyGreenstein(a.y, a.x), 0.0));
            probeOutput(1u, vec4(evalHenyeyGreenstein(a.y, wo, wi)));
            break;
        case 1u:
            probeOutput(0u, vec4(sampleRayleigh(a.x), 0.0));
            probeOutput(1u, vec4(evalRayleigh(wo, wi)));
            break;
        case 2u:
            probeOutput(0u, vec4(sampleTabulated(medium.phaseOffset, medium.phaseCount, Choice(uint(a.z), a.x, 1.0 - a.x)), 0.0));
            probeOutput(1u, vec4(evalTabulated(medium.phaseOffset, medium.phaseCount, wo, wi)));
            break;
        case 3u:
            PhaseFunction phase = choosePhase(medium, word);
            probeOutput(0u, vec4(samplePhase(phase, uint(a.x * 16777216.0) << 8u), 0.0));
            probeOutput(1u, vec4(evalPhase(phase, wo, wi)));
            break;
    }
}
