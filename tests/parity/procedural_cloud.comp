#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "volume/procedural_cloud.glsl"

CloudArguments cloudOfInputs() {
    CloudArguments cloud;
    cloud.frequency = probeInput(1u).xyz;
    cloud.blend = probeInput(1u).w;
    cloud.sharpness = probeInput(2u).x;
    cloud.detailAmount = probeInput(2u).y;
    cloud.warpAmount = probeInput(2u).z;
    cloud.erosionAmount = probeInput(2u).w;
    cloud.densityScale = probeInput(3u).x;
    cloud.densityThreshold = probeInput(3u).y;
    cloud.inverseLargest = probeInput(3u).z;
    cloud.noiseSeed = uint(probeInput(3u).w);
    cloud.modulates = 0u;
    return cloud;
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
