#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "light/sky.glsl"

void probeItem() {
    loadScene();
    vec4 a = probeInput(0u);
    switch (probeFunction) {
        case 0u: probeOutput(0u, vec4(unitPower(a.x, a.y, a.z))); break;
        case 1u: probeOutput(0u, vec4(skyGradient(a.xyz), 0.0)); break;
        case 2u: probeOutput(0u, uintBitsToFloat(uvec4(starCell(a.xyz), findStar(a.xyz), 0u, 0u))); break;
        case 3u: {
            SkyPoint point = SkyPoint(a.xyz, findStar(a.xyz));
            probeOutput(0u, vec4(skyRadiance(point), skyPdf(point)));
            break;
        }
        case 4u: {
            SkyPoint point = sampleSky(floatBitsToUint(a.xyz));
            probeOutput(0u, vec4(point.direction, uintBitsToFloat(point.star)));
            break;
        }
    }
}
