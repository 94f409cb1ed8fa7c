#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "../support/probe.glsl"
#include "integrator/direct_lighting.glsl"
#include "sampling/sampler.glsl"

void probeItem() {
    loadScene();
    vec4 a = probeInput(0u), b = probeInput(1u), c = probeInput(2u);
    PhaseFunction phase = noPhase();
    phase.kind = a.w == 0.0 ? kPhaseIsotropic : kPhaseHenyeyGreenstein;
    phase.g = a.w;
    Scatterer s = Scatterer(a.xyz, b.xyz, phase, b.w != 0.0);
    switch (probeFunction) {
        case 0u:  // axis, g; wo, surface; wi; u
            probeOutput(0u, vec4(evalScatterer(s, c.xyz)));
            probeOutput(1u, sampleScatterer(s, floatBitsToUint(probeInput(3u).xy)));
            break;
        case 1u:  // ten thousand scatterings, one after the other
            uvec2 key = uvec2(7u, probeIndex());
            for (uint i = 0u; i < 10000u; ++i) {
                uvec4 word = draw(key, i, kDrawScatter);
                s.axis = sampleScatterer(s, word.xy).xyz;
            }
            probeOutput(0u, vec4(s.axis, 0.0));
            break;
        case 2u:  // axis, g; wo, surface; position, largest factor; u
            uint tests = 0u;
            DirectLight light = estimateDirect(s, c.xyz, floatBitsToUint(probeInput(3u).xyz), c.w, tests);
            probeOutput(0u, vec4(light.contribution, light.threshold));
            probeOutput(1u, vec4(light.direction, light.distance));
            break;
    }
}
