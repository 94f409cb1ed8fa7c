// What light a path meets adds to its radiance (included by vertex.glsl).
#ifndef INTEGRATOR_EMISSION_GLSL
#define INTEGRATOR_EMISSION_GLSL

// Adds what an event brought, also to the layer of the path's scatterings, which leaves out what is not finite.
void addRadiance(inout Path p, vec3 gain) {
    p.radiance += gain;
    if (hasDepthLayers && depthLayers > 0u) {
        bool bad = any(isnan(gain)) || any(isinf(gain));
        uint layer = firstLayer + min(p.vertex, depthLayers - 1u);
        vec3 high = layers[layer].sumHigh, low = layers[layer].sumLow;
        addCompensated(high, low, bad ? vec3(0.0) : gain);
        layers[layer].sumHigh = high;
        layers[layer].sumLow = low;
    }
}

// Shader only: compared in place in the reference.
bool isTooDeep(Path p) { return hasDepthLimit && p.vertex >= maxDepth; }

// Emission of the surface hit, weighted against next-event estimation at the vertex before.
void addEmission(Path p, Surface surface, uint lightIndex, inout vec3 gain) {
    if (lightIndex == kNone || isTooDeep(p)) return;
    Light light = lightAt(lightIndex);
    float cosine = lightCosine(light, surface.geometricNormal, surface.shadingNormal, -p.ray.direction);
    float pdf = lightPdf(light, p.hit.primitive, p.ray.origin, p.hit.t, cosine);
    if (hasStrategyWeights) pdf *= emitterSamples;
    float weight = emissionWeight(p.lastPdf, pdf);
    if (cosine > 0.0) gain = spectralBeta(p) * emissionAt(light, surface.uv) * weight;
}

void addEnvironment(Path p, inout vec3 gain) {
    if (environmentLight == kNone || isTooDeep(p)) return;
    vec3 radiance = environmentRadiance;
    float pdf = kInvFourPi;
    if (hasEnvironmentMap && scene.lights[environmentLight].type == kLightEnvironmentMap) {
        vec4 point = environmentAt(p.ray.direction);
        radiance = point.rgb;
        pdf = point.w;
    }
    if (hasSky && scene.lights[environmentLight].type == kLightSky) {
        SkyPoint point = SkyPoint(p.ray.direction, hasStars ? findStar(p.ray.direction) : kNone);
        radiance = skyRadiance(point);
        pdf = skyPdf(point);
    }
    float weight = 1.0;
    if (hasEnvironmentSampling) {
        pdf *= scene.lights[environmentLight].selection;
        if (hasStrategyWeights) pdf *= emitterSamples;
        weight = emissionWeight(p.lastPdf, pdf);
    }
    gain = spectralBeta(p) * radiance * weight;
}

#endif
