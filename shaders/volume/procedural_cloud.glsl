// Density of a procedural cloud at p in the unit cube (shaders/README.md, Procedural cloud).
// The same bits on every device: see volume/cloud_noise.glsl.
#ifndef VOLUME_PROCEDURAL_CLOUD_GLSL
#define VOLUME_PROCEDURAL_CLOUD_GLSL

#include "core/math.glsl"
#include "volume/cloud_noise.glsl"

float lengthPrecisely(vec3 v) {
    precise float square = (v.x * v.x + v.y * v.y) + v.z * v.z;
    return roundedSqrt(square);
}

// Distance to a cube with rounded edges, about the centre of the unit cube.
float boxDistance(vec3 p) {
    precise vec3 a = abs(p - 0.5) - kCloudBoxCore;
    precise float outside = lengthPrecisely(max(a, 0.0));
    precise float distance = (outside + min(max(a.x, max(a.y, a.z)), 0.0)) - kCloudBoxRadius;
    return distance;
}

float sphereDistance(vec3 p, vec3 center, float radius) {
    precise vec3 v = p - center;
    precise float distance = lengthPrecisely(v) - radius;
    return distance;
}

// Distance to the heap of spheres that a cloud grows from, from outside.
float blobDistance(vec3 p) {
    float nearest = sphereDistance(p, vec3(0.50, 0.44, 0.50), 0.20);
    nearest = min(nearest, sphereDistance(p, vec3(0.36, 0.41, 0.54), 0.14));
    nearest = min(nearest, sphereDistance(p, vec3(0.65, 0.42, 0.47), 0.15));
    nearest = min(nearest, sphereDistance(p, vec3(0.46, 0.57, 0.46), 0.15));
    nearest = min(nearest, sphereDistance(p, vec3(0.56, 0.40, 0.62), 0.13));
    nearest = min(nearest, sphereDistance(p, vec3(0.45, 0.40, 0.36), 0.13));
    return min(nearest, sphereDistance(p, vec3(0.59, 0.54, 0.54), 0.12));
}

// How far the surface bulges out at p, in units of detailAmount * r.
float cloudDetail(CloudArguments cloud, vec3 p) {
    precise vec3 s = cloud.frequency * p;
    precise vec3 q = s + cloud.warpAmount * (2.0 * fbm(s, cloud.noiseSeed, kCloudStreamWarp) - 1.0);
    precise vec3 coarse = 0.55 * q;
    precise vec3 middle = 1.65 * q;
    precise vec3 fine = 7.0 * q;
    float billow = fbm(coarse, cloud.noiseSeed, kCloudStreamBillow).x;
    float cells = worley(middle, cloud.noiseSeed, kCloudStreamCells);
    float erosion = fbm(fine, cloud.noiseSeed, kCloudStreamErosion).x;
    precise float detail =
        ((0.25 + 0.45 * (billow - 0.5)) + 0.65 * (0.5 - cells)) - cloud.erosionAmount * erosion;
    return detail;
}

// smoothstep(surfaceWidth * r, -surfaceWidth * r, phi), written out: its first edge is above its second.
float cloudSurface(CloudArguments cloud, float phi) {
    precise float t = clamp(0.5 - phi * cloud.sharpness, 0.0, 1.0);
    precise float inside = t * t * (3.0 - 2.0 * t);
    return inside;
}

// A cube that grows into a cloud.
float displacedDensity(CloudArguments cloud, vec3 p) {
    precise float base = (1.0 - cloud.blend) * boxDistance(p) + cloud.blend * blobDistance(p);
    precise float phi = base - (cloud.detailAmount * 0.5) * cloudDetail(cloud, p);
    precise float density = clamp(cloudSurface(cloud, phi) * cloud.densityScale, 0.0, 1.0);
    return density < cloud.densityThreshold ? 0.0 : density;
}

// A given density, thinned where the detail is low: most where it is thin already, not at all at its largest.
float modulatedDensity(CloudArguments cloud, vec3 p, float base) {
    precise float middle = kCloudMeanDetail - 0.5 * cloud.erosionAmount;
    precise float eroded = cloudSurface(cloud, 0.5 * (cloudDetail(cloud, p) - middle));
    precise float thin = 1.0 - base * cloud.inverseLargest;
    precise float density = base * (1.0 - cloud.blend * eroded * thin);
    return density < cloud.densityThreshold ? 0.0 : density;
}

// `base` counts in a field that modulates only.
float cloudDensity(CloudArguments cloud, vec3 p, float base) {
    float displaced = displacedDensity(cloud, p);
    float modulated = modulatedDensity(cloud, p, base);
    return cloud.modulates != 0u ? modulated : displaced;
}

#endif
