#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "volume/density.glsl"

void probeItem() {
    uint index = floatBitsToUint(probeInput(0u).w);
    Medium medium = scene.media[index];
    vec3 position = probeInput(0u).xyz, u = probeInput(1u).xyz;
    switch (probeFunction) {
        case 0u: probeOutput(0u, vec4(densityVoxel(medium, uvec3(position)))); break;
        case 1u:
            probeOutput(0u, vec4(stochasticCorner(position, medium.resolution, u), 0.0));
            probeOutput(1u, vec4(trilinearDensity(medium, position), 0.0));
            probeOutput(2u, vec4(densityAt(medium, position, u), 0.0));
            break;
        case 3u: probeOutput(0u, vec4(colorVoxel(medium, uvec3(position)), 0.0)); break;
        case 4u: probeOutput(0u, vec4(voxelAt(medium, uvec3(position)), 0.0)); break;
        case 2u: probeOutput(0u, vec4(albedoAt(medium, position, u), 0.0)); break;
    }
}
