#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "light/surrounding.glsl"

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
        case 3u: {  // a light of either kind
            LightSample s = sampleSurrounding(scene.lights[0], floatBitsToUint(a.xyz));
            probeOutput(0u, vec4(s.direction, s.pdf));
            probeOutput(1u, vec4(s.radianceOverPdf, s.distance));
            break;
        }
        case 2u: probeOutput(0u, sampleEnvironment(floatBitsToUint(a.xyz))); break;
    }
}
