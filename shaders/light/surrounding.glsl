// Lights that surround the scene.
#ifndef LIGHT_SURROUNDING_GLSL
#define LIGHT_SURROUNDING_GLSL

#include "light/environment.glsl"
#include "light/light_sample.glsl"
#include "light/sky.glsl"
#include "sampling/warp.glsl"

// A direction towards a light that surrounds the scene, by the words x, y and z of a light draw.
LightSample sampleSurrounding(Light light, uvec3 words) {
    LightSample result = LightSample(vec3(0.0, 0.0, 1.0), kInfinity, vec3(0.0), 1.0, kNone);
    if (light.type == kLightEnvironment) {
        float pdf = kInvFourPi * light.selection;
        result = LightSample(uniformSphere(vec2(toUniform(words.x), toUniform(words.y))), kInfinity, light.emission * safeDivide(1.0, pdf), pdf, kNone);
    }
    if (hasEnvironmentMap && light.type == kLightEnvironmentMap) {
        vec4 point = sampleEnvironment(words);
        float pdf = point.w * light.selection;
        vec3 radiance = environmentAt(point.xyz).rgb;
        result = LightSample(point.xyz, kInfinity, radiance * safeDivide(1.0, pdf), pdf, kNone);
    }
    if (hasSky && light.type == kLightSky) {
        SkyPoint point = sampleSky(words);
        float pdf = skyPdf(point) * light.selection;
        result = LightSample(point.direction, kInfinity, skyRadiance(point) * safeDivide(1.0, pdf), pdf, kNone);
    }
    return result;
}

#endif
