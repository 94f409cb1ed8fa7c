#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "light/environment.glsl"

void probeItem() {
    loadScene();
    vec4 a = probeInput(0u);
    switch (probeFunction) {
        case 0u: {
            EnvironmentPlace place = environmentPlace(a.xyz);
            probeOutput(0u, vec4(uintBitsToFloat(uvec2(place.column, place.row)), place.fraction));
            break;
        }
        case 1u: probeOutput(0u, environmentAt(a.xyz)); break;
        case 2u: probeOutput(0u, sampleEnvironment(floatBitsToUint(a))); break;
    }
}
