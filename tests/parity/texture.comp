#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "../support/probe.glsl"
#include "light/area_light.glsl"

void probeItem() {
    loadScene();
    vec4 a = probeInput(0u);
    uint index = floatBitsToUint(a.w);
    switch (probeFunction) {
        case 0u:
            probeOutput(0u, vec4(textureAt(index, a.xy), 0.0));
            probeOutput(1u, vec4(reflectanceAt(Shape(vec3(0.5, 0.25, 0.75), 0u, kNone, kNone, kNone, index), a.xy), 0.0));
            Light light = scene.lights[0];
            light.texture = index;
            probeOutput(2u, vec4(emissionAt(light, a.xy), 0.0));
            break;
        case 1u:  // coordinate; index, size, flags
            probeOutput(0u, vec4(wrapCoordinate(a.x, index), float(wrapTexel(int(a.y), int(a.z), index)), 0.0, 0.0));
            break;
        case 2u:  // normal
            probeOutput(0u, vec4(sphereUv(scene.spheres[0], a.xyz), angleOf(a.y, a.x), 0.0));
            break;
        case 3u: probeOutput(0u, vec4(boxUv(scene.boxes[0], a.xyz), triangleUv(index, a.xy))); break;
    }
}
