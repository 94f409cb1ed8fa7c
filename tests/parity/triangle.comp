#version 460
#include "../support/probe.glsl"
#include "geometry/ray.glsl"
#include "geometry/triangle.glsl"

Hit hitOf(vec4 v) { return Hit(v.x, floatBitsToUint(v.y), vec2(0.0), v.z != 0.0); }

void probeItem() {
    switch (probeFunction) {
        case 0u:
            RayShear shear = rayShear(probeInput(1u).xyz);
            probeOutput(0u, vec4(intersectTriangle(probeInput(0u).xyz, shear, probeInput(2u).xyz, probeInput(3u).xyz,
                                                   probeInput(4u).xyz), 0.0));
            probeOutput(1u, vec4(shear.shear, shear.axes.z));
            break;
        case 1u:
            Hit best = hitOf(probeInput(0u));
            keepNearer(best, hitOf(probeInput(1u)));
            probeOutput(0u, vec4(best.t, uintBitsToFloat(best.primitive), best.exits, 0.0));
            break;
    }
}
