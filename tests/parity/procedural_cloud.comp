#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "volume/procedural_cloud.glsl"

CloudArguments cloudOfInputs() {
    vec4 grid = probeInput(1u), noise = probeInput(2u), density = probeInput(3u);
    return CloudArguments(grid.xyz, grid.w, vec3(0.0), noise.x, noise.y, noise.z, noise.w, density.x, density.y,
                          density.z, uint(density.w), 0u, uvec3(0u), 0u, 0u);
}

void probeNoise() {
    vec3 x = probeInput(0u).xyz;
    uint seed = uint(probeInput(1u).x), stream = uint(probeInput(1u).y);
    probeOutput(0u, vec4(valueNoise(x, seed, stream), worley(x, seed, stream)));
    probeOutput(1u, vec4(fbm(x, seed, stream), 0.0));
    probeOutput(2u, vec4(cellUniforms(ivec3(floor(x)), seed, stream), 0.0));
    probeOutput(3u, vec4(lerpPrecisely(x, probeInput(1u).xyz, probeInput(0u).w), 0.0));
}

void probeCloud() {
    CloudArguments cloud = cloudOfInputs();
    vec3 p = probeInput(0u).xyz;
    float base = probeInput(0u).w;
    float displaced = cloudDensity(cloud, p, base);
    cloud.modulates = 1u;
    probeOutput(0u, vec4(boxDistance(p), blobDistance(p), cloudDetail(cloud, p), cloudSurface(cloud, p.x - 0.5)));
    probeOutput(1u, vec4(displacedDensity(cloud, p), modulatedDensity(cloud, p, base), displaced, cloudDensity(cloud, p, base)));
    probeOutput(2u, vec4(lengthPrecisely(p), sphereDistance(p, vec3(0.25, 0.5, 0.75), 0.125), 0.0, 0.0));
}

void probeItem() {
    switch (probeFunction) {
        case 0u: probeNoise(); break;
        case 1u: probeCloud(); break;
    }
}
