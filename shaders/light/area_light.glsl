// Samples of one area light, by solid angle or by area.
#ifndef LIGHT_AREA_LIGHT_GLSL
#define LIGHT_AREA_LIGHT_GLSL

#include "core/frame.glsl"
#include "core/scene.glsl"
#include "geometry/intersection.glsl"
#include "light/light_sample.glsl"
#include "sampling/distribution.glsl"
#include "sampling/sampler.glsl"
#include "sampling/warp.glsl"
#include "surface/texture.glsl"

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

// Cosine at an area light of what leaves along `outgoing`, which need not be unit; 0 where nothing does. Which side
// emits is the shading normal's to say.
float lightCosine(Light light, vec3 geometricNormal, vec3 shadingNormal, vec3 outgoing) {
    bool emits = dot(shadingNormal, outgoing) > 0.0;
    if (hasTwoSidedLights) emits = emits || (light.flags & kLightTwoSided) != 0u;
    return emits ? abs(dot(geometricNormal, outgoing)) : 0.0;
}

// Radiance of an area light at (u, v) of its surface.
vec3 emissionAt(Light light, vec2 uv) {
    if (!hasTexturedLights) return light.emission;
    return light.emission * textureAt(light.texture, uv);
}

// 1 - cos of the half angle under which a sphere is seen from outside; 0 from inside (H62) and from so close that
// rounding could take a point of the sphere for one outside: scattering finds the light there.
float oneMinusCosCone(vec3 toCenter, float radius) {
    float sine2 = radius * radius / dot(toCenter, toCenter);
    return sine2 < kFarthestCone ? sine2 / (1.0 + sqrt(1.0 - sine2)) : 0.0;
}

LightSample sampleSphereLight(Light light, vec3 position, vec2 u) {
    Sphere s = sphereOf(light);
    vec3 toCenter = s.center - position;
    float cone = oneMinusCosCone(toCenter, s.radius);
    float pdf = light.selection * safeDivide(0.5 * kInvPi, cone);
    vec3 direction = toWorld(frameFromNormal(normalize(toCenter)), uniformCone(u, cone));
    vec2 interval = sphereInterval(s.center, s.radius, position, direction);
    float distance = interval.y >= interval.x ? interval.x : dot(toCenter, direction);  // grazing: rounding missed it
    vec2 uv = hasTexturedLights ? sphereUv(s, normalize(position + distance * direction - s.center)) : vec2(0.0);
    return LightSample(direction, distance, emissionAt(light, uv) * safeDivide(1.0, pdf), pdf, light.primitive);
}

// Sample of an area given by a point on it and what it is there.
LightSample sampleArea(Light light, vec3 position, vec3 point, vec2 uv, vec3 geometricNormal, vec3 shadingNormal,
                       float area, uint primitive) {
    vec3 toLight = point - position;
    float square = dot(toLight, toLight);
    float distance = sqrt(square);
    vec3 direction = toLight * safeDivide(1.0, distance);
    float cosine = lightCosine(light, geometricNormal, shadingNormal, -direction);
    float pdf = light.selection * safeDivide(square, cosine * area);
    return LightSample(direction, distance, emissionAt(light, uv) * safeDivide(1.0, pdf), pdf, primitive);
}

// 1 / the density per unit of area with which sampleMeshLight finds a point of a triangle: about the area of its mesh.
float meshArea(uint primitive) {
    return texelFetch(triangleAreas, int(primitive - (quadCount + sphereCount + boxCount))).x;
}

LightSample sampleMeshLight(Light light, vec3 position, uvec3 words) {
    Choice choice = invertDistribution(light.distribution, light.triangleCount, words.x, fillDigits(words.z).x);
    uint primitive = texelFetch(lightTriangleTexels, int(light.triangleOffset + choice.entry)).x;
    vec3 b = uniformTriangle(vec2(choice.offset, toUniform(words.y)));
    uint first = quadCount + sphereCount + boxCount;
    Surface surface = triangleSurface(primitive - first, b.yz);
    return sampleArea(light, position, surface.position, surface.uv, surface.geometricNormal, surface.shadingNormal,
                      meshArea(primitive), primitive);
}

#endif
