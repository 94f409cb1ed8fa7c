#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "../support/probe.glsl"
#include "geometry/intersection.glsl"

void probeItem() {
    loadScene();
    vec4 a = probeInput(0u), b = probeInput(1u), c = probeInput(2u);  // origin, tMin; direction; last, inside
    Ray ray = newRay(a.xyz, b.xyz, kInfinity, floatBitsToUint(c.x), kNone, floatBitsToUint(c.y), -1.0);
    ray.tMin = a.w;
    bool ok = true;
    uint tests = 0u;
    Hit hit = closestHit(ray, true, tests, ok);
    probeOutput(0u, uintBitsToFloat(uvec4(hit.primitive, noticeEntry(ray, hit), 0u, 0u)));
}
