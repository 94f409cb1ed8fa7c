// Light sampling for next-event estimation, and the densities its MIS weights need.
#ifndef LIGHT_LIGHT_GLSL
#define LIGHT_LIGHT_GLSL

#include "core/scene.glsl"
#include "light/area_light.glsl"
#include "light/surrounding.glsl"

// First light whose cumulative probability is above u.
uint selectLight(float u) {
    uint low = 0u;
    if (hasManyLights) {
        uint high = max(scene.lightCount, 1u) - 1u;  // without lights they may have been asked for all the same
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

// A light seen from `position`, chosen and placed by the words x, y and z of a light draw.
LightSample sampleLight(vec3 position, uvec3 words, inout uint tests) {
    uint index = selectLight(toUniform(words.x));
    tests += hasManyLights ? 9u : 0u;
    Light light = lightAt(index);
    if (hasManyLights) {
        float below = index == 0u ? 0.0 : scene.lights[index - 1u].cumulative;
        words.xz = zoomWord(words.xz, uint(below * 16777216.0) << 8u, uint(light.selection * 16777216.0) << 8u, light.reciprocal);
    }
    vec2 u = vec2(toUniform(words.x), toUniform(words.y));
    // Of a mesh's triangles, a sky's bands and stars, or a map's rows and cells; and of findStar.
    if (hasEnvironmentMap || hasSky || (hasAreaLights && hasTriangles)) tests += 2u * (kSearchSteps + 1u);
    tests += hasStars ? kMaxStarsPerCell + 1u : 0u;
    LightSample result = LightSample(vec3(0.0, 0.0, 1.0), kInfinity, vec3(0.0), 1.0, kNone);
    if (hasAreaLights && light.type == kLightQuad) {
        Quad q = quadOf(light);
        vec3 point = q.corner + u.x * q.edgeU + u.y * q.edgeV;
        result = sampleArea(light, position, point, u, q.normal, q.normal, q.area, light.primitive);
    }
    if (hasAreaLights && hasSpheres && light.type == kLightSphere) result = sampleSphereLight(light, position, u);
    if (hasAreaLights && hasTriangles && light.type == kLightMesh) result = sampleMeshLight(light, position, words);
    if (hasDeltaLights && light.type == kLightDirectional)
        result = LightSample(-light.vector, kInfinity, light.emission * safeDivide(1.0, light.selection), kInfinity, kNone);
    if (hasDeltaLights && light.type == kLightPoint) {
        vec3 toLight = light.vector - position;
        float square = dot(toLight, toLight);
        float inverse = safeDivide(1.0, square);
        result = LightSample(toLight * sqrt(inverse), sqrt(square),
                             light.emission * (inverse * safeDivide(1.0, light.selection)), kInfinity, kNone);
    }
    if (hasEnvironmentSampling && light.type >= kLightEnvironment) result = sampleSurrounding(light, words);
    return result;
}

// Density per steradian, selection included, with which sampleLight finds the direction of a ray that
// left `origin` and met a primitive of the light after distance t under `cosine` (see lightCosine).
float lightPdf(Light light, uint primitive, vec3 origin, float t, float cosine) {
    float pdf = 0.0;
    if (light.type == kLightQuad) pdf = safeDivide(t * t, cosine * quadOf(light).area);
    if (hasTriangles && light.type == kLightMesh) pdf = safeDivide(t * t, cosine * meshArea(primitive));
    if (hasSpheres && light.type == kLightSphere) {
        Sphere s = sphereOf(light);
        pdf = safeDivide(0.5 * kInvPi, oneMinusCosCone(s.center - origin, s.radius));
    }
    if (light.type == kLightEnvironment) pdf = kInvFourPi;
    return pdf * light.selection;
}

#endif
