#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "shared/scene_types.h"
#include "geometry/ray.glsl"
#include "geometry/triangle.glsl"

Hit hitOf(vec4 v) { return Hit(v.x, floatBitsToUint(v.y), vec2(0.0), v.z != 0.0, false); }

void probeItem() {
    switch (probeFunction) {
        case 0u:
            RayShear shear = rayShear(probeInput(1u).xyz);
            probeOutput(0u, intersectTriangle(probeInput(0u).xyz, shear, probeInput(2u).xyz, probeInput(3u).xyz,
                                              probeInput(4u).xyz, probeInput(0u).w));
            probeOutput(1u, vec4(shear.shear, shear.axes.z));
            break;
        case 1u:
            Hit best = hitOf(probeInput(0u));
            keepNearer(best, hitOf(probeInput(1u)));
            probeOutput(0u, vec4(best.t, uintBitsToFloat(best.primitive), best.exits, 0.0));
            break;
        case 2u:
            // tMin, passed, slack; t, error, primitive: a flat primitive offered to a ray that has met nothing.
            vec4 a = probeInput(0u), b = probeInput(1u);
            Ray ray = newRay(vec3(0.0), vec3(0.0, 0.0, 1.0), 8.0, 6u, 7u, kNone, a.z);
            ray.tMin = a.x;
            ray.passed = floatBitsToUint(a.y);
            Hit none = Hit(8.0, kNone, vec2(0.0), false, false);
            hitFlat(none, ray, b.x, b.y, floatBitsToUint(b.z), vec2(0.0));
            probeOutput(0u, vec4(none.t, uintBitsToFloat(none.primitive), none.near, isAhead(ray, b.x, floatBitsToUint(b.z))));
            break;
        case 3u:
            vec4 c = probeInput(0u), d = probeInput(1u);
            probeOutput(0u, vec4(distanceError(c.xyz, c.w, d.x, d.y, d.z)));
            break;
    }
}
