#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "core/scene.glsl"
#include "geometry/primitives.glsl"

void probeItem() {
    uint index = floatBitsToUint(probeInput(0u).w);
    vec3 origin = probeInput(0u).xyz, direction = probeInput(1u).xyz;
    switch (probeFunction) {
        case 0u:
            probeOutput(0u, vec4(intersectQuad(scene.quads[index], origin, direction),
                                 quadDistanceError(scene.quads[index], origin, direction, probeInput(1u).w), 0.0, 0.0));
            break;
        case 1u:
            probeOutput(0u, vec4(sphereInterval(scene.spheres[index].center, scene.spheres[index].radius, origin, direction), 0.0, 0.0));
            break;
        case 2u: probeOutput(0u, vec4(boxInterval(scene.boxes[index].localFromWorld, origin, direction), 0.0, 0.0)); break;
    }
}
