#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "../support/probe.glsl"
#include "light/light.glsl"

void put(LightSample s) {
    probeOutput(0u, vec4(s.direction, s.distance));
    probeOutput(1u, vec4(s.radianceOverPdf, s.pdf));
    probeOutput(2u, vec4(uintBitsToFloat(s.target), 0.0, 0.0, 0.0));
}

void probeItem() {
    loadScene();
    uint tests = 0u;
    vec3 position = probeInput(0u).xyz, u = probeInput(1u).xyz;
    uvec3 words = floatBitsToUint(u);
    switch (probeFunction) {
        case 0u:
            put(sampleLight(position, words, tests));
            probeOutput(2u, vec4(uintBitsToFloat(uvec2(sampleLight(position, words, tests).target, selectLight(toUniform(words.x)))), 0.0, 0.0));
            break;
        case 1u: probeOutput(0u, vec4(oneMinusCosCone(position, probeInput(0u).w))); break;
        case 2u:  // origin; distance, cosine, light
            probeOutput(0u, vec4(lightPdf(scene.lights[uint(u.z)], scene.lights[uint(u.z)].primitive, position, u.x, u.y)));
            break;
        case 3u:  // geometric normal, light; outgoing; shading normal
            probeOutput(0u, vec4(lightCosine(scene.lights[uint(probeInput(0u).w)], position, probeInput(2u).xyz, u)));
            break;
        case 4u: probeOutput(0u, vec4(meshArea(uint(u.x)))); break;
    }
}
