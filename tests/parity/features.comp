#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "../support/probe.glsl"
#include "integrator/features.glsl"

void probeItem() {
    loadScene();
    uvec4 a = uvec4(probeInput(0u));  // pixel, width, sample
    FeaturePixel sums = FeaturePixel(vec3(0.0), 0.0, vec3(0.0), 0.0);
    uvec4 word = draw(pathKey(a.y * a.z + a.x, a.w, 0u, 5u), 0u, kDrawFeature);
    uint tests = 0u;
    bool ok = addFeature(sums, a.xy, vec2(toUniform(word.x), toUniform(word.y)), tests, 64u);
    probeOutput(0u, vec4(sums.albedo, sums.depth));
    probeOutput(1u, vec4(sums.normal, ok ? sums.hits : -1.0));
}
