// Next-event estimation at a vertex, weighted against scattering towards the light by chance.
#ifndef INTEGRATOR_DIRECT_LIGHTING_GLSL
#define INTEGRATOR_DIRECT_LIGHTING_GLSL

#include "light/light.glsl"
#include "sampling/mis.glsl"
#include "surface/bsdf.glsl"
#include "volume/phase_function.glsl"

// What scatters: a diffuse surface about its normal, or a phase function about the direction of travel.
struct Scatterer {
    vec3 axis;   // shading normal, or direction of travel (any axis where scattering is isotropic)
    vec3 wo;
    PhaseFunction phase;
    bool surface;
};

// Scattering value towards wi, per steradian; also the density of sampleScatterer. Surfaces leave
// the reflectance out.
float evalScatterer(Scatterer s, vec3 wi) {
    float value = evalPhase(s.phase, s.wo, wi);
    if (hasSurfaces && s.surface) value = evalDiffuse(s.axis, wi);
    return value;
}

// Direction (xyz) and its density (w), from the words x and y of a scatter draw.
vec4 sampleScatterer(Scatterer s, uvec2 words) {
    vec2 u = vec2(toUniform(words.x), toUniform(words.y));
    vec3 polar = samplePhase(s.phase, words.x);
    vec2 sc = sinCosTurn(u.y);
    vec3 local = vec3(polar.y * vec2(sc.y, sc.x), polar.x);
    if (hasSurfaces && s.surface) {
        local = sampleDiffuse(u);
        polar.z = pdfDiffuse(local.z);
    }
    return vec4(normalize(toWorld(frameFromNormal(s.axis), local)), polar.z);
}

struct DirectLight {
    vec3 contribution;  // without throughput and without what is in the way
    vec3 direction;
    float distance;
    uint target;
    float threshold;    // of the shadow ray's roulette
};

// `words`: x, y and z of the light draw. `largestFactor`: largest channel of a surface's reflectance, 1 in media.
DirectLight estimateDirect(Scatterer s, vec3 position, uvec3 words, float largestFactor, inout uint tests) {
    LightSample light = sampleLight(position, words, tests);
    float value = evalScatterer(s, light.direction);
    float pdf = light.pdf, scatterPdf = value;
    if (hasStrategyWeights) {
        pdf *= emitterSamples;
        scatterPdf *= scatterSamples;
    }
    vec3 contribution = light.radianceOverPdf * (value * balanceHeuristic(pdf, scatterPdf));
    float threshold = min(1.0, shadowRoulette * safeDivide(kInvFourPi, value * largestFactor));
    return DirectLight(contribution, light.direction, light.distance, light.target, threshold);
}

#endif
