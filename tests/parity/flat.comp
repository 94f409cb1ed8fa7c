#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "../support/probe.glsl"
#include "geometry/intersection.glsl"

// A ray (origin, slack; direction) that left primitive c.x, from a point of these weights, has met c.y near, at c.z.
void meetNeighbour() {
    vec4 a = probeInput(0u), c = probeInput(2u);
    Ray ray = newRay(a.xyz, probeInput(1u).xyz, kInfinity, floatBitsToUint(c.x), kNone, kNone, a.w);
    Hit left = Hit(0.0, ray.last, vec2(1.0 / 3.0), false, false);
    Hit hit = Hit(c.z, floatBitsToUint(c.y), vec2(1.0 / 3.0), false, true);
    Start start = Start(surfaceAt(ray, left).face, probeInput(3u).xy);
    bool isFlat = isFlatPrimitive(hit.primitive);
    bool aside = leavesAside(ray, hit, surfaceAt(ray, hit), start);
    probeOutput(0u, vec4(isFlat, aside, 0.0, 0.0));
}

// A ray along z with a memory (idle, idleT, passed, tMin), inside c.y, crosses a boundary of a shape (with its exterior,
// primitive) at c.z; its normal's z is c.w.
void cross_() {
    vec4 a = probeInput(0u), b = probeInput(1u), c = probeInput(2u);
    Ray ray = newRay(vec3(0.0), vec3(0.0, 0.0, 1.0), kInfinity, kNone, kNone, floatBitsToUint(c.y), -1.0);
    ray.idle = floatBitsToUint(a.x);
    ray.idleT = a.y;
    ray.passed = floatBitsToUint(a.z);
    ray.tMin = a.w;
    Hit hit = Hit(c.z, floatBitsToUint(b.w), vec2(0.0), false, false);
    crossBoundary(ray, hit, floatBitsToUint(b.x), floatBitsToUint(b.y), vec3(0.0, 0.0, c.w));
    probeOutput(0u, vec4(uintBitsToFloat(ray.inside), uintBitsToFloat(ray.idle), ray.idleT, uintBitsToFloat(ray.passed)));
    probeOutput(1u, vec4(ray.tMin));
}

void probeItem() {
    loadScene();
    if (probeFunction == 0u) meetNeighbour();
    if (probeFunction == 1u) cross_();
}
