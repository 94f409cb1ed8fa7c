// Light sampling for next-event estimation, and the densities its MIS weights need.
#ifndef LIGHT_LIGHT_GLSL
#define LIGHT_LIGHT_GLSL

#include "core/frame.glsl"
#include "core/scene.glsl"
#include "geometry/intersection.glsl"
#include "light/surrounding.glsl"
#include "sampling/distribution.glsl"
#include "sampling/warp.glsl"

// Shader only: the reference refers to lights.
Light lightAt(uint index) {
    if (!hasManyLights) return nearLight;
    return scene.lights[index];
}

// Shader only: as above.
Quad quadOf(Light light) {
    if (!hasManyLights) return nearLightQuad;
    return scene.quads[light.primitive];
}

// Shader only: as above.
Sphere sphereOf(Light light) {
    if (!hasManyLights) return nearLightSphere;
    return scene.spheres[light.primitive - quadCount];
}

// Cosine at an area light of what leaves along `outgoing`, which need not be unit; 0 where nothing does.
float lightCosine(Light light, vec3 normal, vec3 outgoing) {
    float cosine = dot(normal, outgoing);
    if (hasTwoSidedLights && (light.flags & kLightTwoSided) != 0u) cosine = abs(cosine);
    return max(cosine, 0.0);
}

// First light whose cumulative probability is above u.
uint selectLight(float u) {
    uint low = 0u;
    if (hasManyLights) {
        uint high = scene.lightCount - 1u;
        for (uint i = 0u; i < 8u; ++i) {  // kMaxLights = 2^8
            uint middle = (low + high) / 2u;
            bool above = scene.lights[middle].cumulative > u;
            high = above ? middle : high;
            low = above ? low : min(middle + 1u, high);
        }
        low = high;
    }
    return low;
}

// 1 - cos of the half angle under which a sphere is seen from outside; 0 from inside (numerics H62).
float oneMinusCosCone(vec3 toCenter, float radius) {
    float sine2 = radius * radius / dot(toCenter, toCenter);
    return sine2 < 1.0 ? sine2 / (1.0 + sqrt(1.0 - sine2)) : 0.0;
}

LightSample sampleSphereLight(Light light, vec3 position, vec2 u) {
    Sphere s = sphereOf(light);
    vec3 toCenter = s.center - position;
    float cone = oneMinusCosCone(toCenter, s.radius);
    float pdf = light.selection * safeDivide(0.5 * kInvPi, cone);
    vec3 direction = toWorld(frameFromNormal(normalize(toCenter)), uniformCone(u, cone));
    vec2 interval = sphereInterval(s.center, s.radius, position, direction);
    float distance = interval.y >= interval.x ? interval.x : dot(toCenter, direction);  // grazing: rounding missed it
    return LightSample(direction, distance, light.emission * safeDivide(1.0, pdf), pdf, light.primitive);
}

// Sample of an area given by a point on it, its front normal and its area.
LightSample sampleArea(Light light, vec3 position, vec3 point, vec3 normal, float area, uint primitive) {
    vec3 toLight = point - position;
    float square = dot(toLight, toLight);
    float distance = sqrt(square);
    vec3 direction = toLight * safeDivide(1.0, distance);
    float cosine = lightCosine(light, normal, -direction);
    float pdf = light.selection * safeDivide(square, cosine * area);
    return LightSample(direction, distance, light.emission * safeDivide(1.0, pdf), pdf, primitive);
}

LightSample sampleMeshLight(Light light, vec3 position, float selector, vec2 u, inout uint tests) {
    uint entry = light.cdfOffset + firstAbove(light.cdfOffset, light.triangleCount, selector);
    tests += kSearchSteps + 1u;
    uint primitive = texelFetch(lightTriangleTexels, int(entry)).x;
    vec3 b = uniformTriangle(u);
    uint first = quadCount + sphereCount + boxCount;
    Surface surface = triangleSurface(primitive - first, b.yz);
    return sampleArea(light, position, surface.position, surface.geometricNormal, light.area, primitive);
}

// A light seen from `position`, chosen by u.x, placed by u.yz, or by `words` (the environment draw) on a map or sky.
LightSample sampleLight(vec3 position, vec3 u, uvec4 words, inout uint tests) {
    uint index = selectLight(u.x);
    tests += hasManyLights ? 9u : 0u;
    Light light = lightAt(index);
    LightSample result = LightSample(vec3(0.0, 0.0, 1.0), kInfinity, vec3(0.0), 1.0, kNone);
    if (hasAreaLights && light.type == kLightQuad) {
        Quad q = quadOf(light);
        vec3 point = q.corner + u.y * q.edgeU + u.z * q.edgeV;
        result = sampleArea(light, position, point, q.normal, q.area, light.primitive);
    }
    if (hasAreaLights && hasSpheres && light.type == kLightSphere) result = sampleSphereLight(light, position, u.yz);
    if (hasAreaLights && hasTriangles && light.type == kLightMesh) {
        float below = index == 0u ? 0.0 : scene.lights[index - 1u].cumulative;
        float rest = clamp(safeDivide(u.x - below, light.selection), 0.0, 0.99999994);
        result = sampleMeshLight(light, position, rest, u.yz, tests);
    }
    if (hasDeltaLights && light.type == kLightDirectional)
        result = LightSample(-light.vector, kInfinity, light.emission / light.selection, kInfinity, kNone);
    if (hasDeltaLights && light.type == kLightPoint) {
        vec3 toLight = light.vector - position;
        float square = dot(toLight, toLight);
        float inverse = safeDivide(1.0, square);
        result = LightSample(toLight * sqrt(inverse), sqrt(square), light.emission * inverse / light.selection,
                             kInfinity, kNone);
    }
    if (hasEnvironmentSampling && light.type >= kLightEnvironment) result = sampleSurrounding(light, u.yz, words);
    tests += hasStars ? kMaxStarsPerCell + 1u : 0u;
    return result;
}

// Density per steradian, selection included, with which sampleLight finds the direction of a ray that
// left `origin` and met the light after distance t under `cosine` (see lightCosine).
float lightPdf(Light light, vec3 origin, float t, float cosine) {
    float pdf = 0.0;
    if (light.type == kLightQuad) pdf = safeDivide(t * t, cosine * quadOf(light).area);
    if (light.type == kLightMesh) pdf = safeDivide(t * t, cosine * light.area);
    if (hasSpheres && light.type == kLightSphere) {
        Sphere s = sphereOf(light);
        pdf = safeDivide(0.5 * kInvPi, oneMinusCosCone(s.center - origin, s.radius));
    }
    if (light.type == kLightEnvironment) pdf = kInvFourPi;
    return pdf * light.selection;
}

#endif
