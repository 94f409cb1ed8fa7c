// Events of a path: vertices, boundaries, ends (included by path_tracer.glsl).
#ifndef INTEGRATOR_VERTEX_GLSL
#define INTEGRATOR_VERTEX_GLSL

#include "integrator/emission.glsl"

// What a vertex scatters with, for the lanes that have one.
struct Vertex {
    bool scatters;
    Scatterer scatterer;
    vec3 factor;  // reflectance or albedo
};

// Scatters: roulette, light sampling, and the directions of the rays to come.
uint scatter(inout Path p, Vertex v, inout DirectLight light, inout uvec2 shadowExponential, inout Counts counts) {
    ++p.vertex;
    ++counts.vertices;
    p.beta *= v.factor;
    uvec4 word = drawStratified(p.stream, p.vertex, kDrawScatter);
    float largest = maxComponent(spectralBeta(p));
    // Far below what a film resolves, roulette at any depth: throughput must not sink into denormals (H37).
    float survival = p.vertex >= rouletteDepth || largest < 1e-20 ? clamp(largest, 0.05, 1.0) : 1.0;
    bool alive = !isTooDeep(p) && largest > 0.0 && toUniform(word.w) < survival;
    p.beta /= survival;
    vec4 next = sampleScatterer(v.scatterer, word.xy);
    counts.tests += hasTabulatedPhase ? kSearchSteps + 1u : 0u;
    p.lastPdf = hasStrategyWeights ? next.w * scatterSamples : next.w;
    p.nextDirection = next.xyz;
    p.nextExponential = uvec2(word.z, spareBits(word.x, word.y, word.w));
    bool shadow = false;
    if (hasDeltaLights || hasAreaLights || hasEnvironmentSampling) {
        uvec4 choice = drawStratified(p.stream, p.vertex, kDrawLight);
        float largestFactor = v.scatterer.surface ? maxComponent(v.factor) : 1.0;
        light = estimateDirect(v.scatterer, p.vertexPosition, choice.xyz, largestFactor, counts.tests);
        p.pending = spectralBeta(p) * light.contribution;
        shadow = maxComponent(p.pending) > 0.0;
        shadowExponential = uvec2(choice.w, spareBits(choice.x, choice.y, choice.z));
    }
    return alive ? (shadow ? kShadow : kFlight) : kFinish;
}

// An opaque surface ended the flight: emission, then what scatters.
Vertex surfaceVertex(inout Path p, Surface surface, Shape shape, inout vec3 gain) {
    if (hasAreaLights) addEmission(p, surface, shape.light, gain);
    vec3 wo = -p.ray.direction;
    vec3 normal = surface.shadingNormal;
    if (hasDoubleSided && (shape.flags & kShapeTwoSided) != 0u && dot(normal, wo) < 0.0) normal = -normal;
    p.vertexPosition = surface.position;
    p.vertexStart = Start(surface.face, surface.weights);
    p.vertexOffset = surface.geometricNormal * surface.offset;
    p.vertexSlack = surface.slack;
    p.vertexLast = p.hit.primitive;
    p.vertexInside = p.ray.inside;
    return Vertex(dot(normal, wo) > 0.0, Scatterer(normal, wo, noPhase(), true), reflectanceAt(shape, surface.uv));
}

// A real collision at the segment's t.
Vertex mediumVertex(inout Path p) {
    Medium medium = mediumAt(hasManyMedia ? interiorOf(p.ray.inside) : 0u);
    p.vertexPosition = p.ray.origin + p.segment.t * p.ray.direction;
    leaveNoSurface(p);
    p.vertexLast = kNone;
    p.vertexInside = p.ray.inside;
    uvec4 word = uvec4(0u);
    if (hasAlbedoGrids || hasDualHenyeyGreenstein || hasTabulatedPhase) word = draw(p.stream.key, p.vertex + 1u, kDrawAlbedo);
    vec3 corner = vec3(toUniform(word.x), toUniform(word.y), toUniform(word.z));
    PhaseFunction phase = choosePhase(medium, word.w);
    vec3 axis = phase.kind == kPhaseIsotropic ? vec3(0.0, 0.0, 1.0) : p.ray.direction;
    return Vertex(true, Scatterer(axis, -p.ray.direction, phase, false),
                  albedoAt(medium, p.vertexPosition, corner));
}

// The segment's end was reached: a boundary to cross, a surface, the light, or nothing at all.
// Shader only: within fly and handleEvent in the reference.
uint arrive(inout Path p, inout Vertex vertex) {
    bool miss = p.hit.primitive == kNone;
    Surface surface = surfaceAt(p.ray, p.hit);
    Shape shape = shapeAt(miss ? 0u : surface.shape);
    bool boundary = !miss && (shape.flags & kShapeNull) != 0u;
    uint next = kFinish;
    vec3 gain = vec3(0.0);
    if (boundary) {
        crossBoundary(p.ray, p.hit, surface.shape, shape.exterior, surface.geometricNormal);
        next = kCross;
    } else if (!miss && leavesAside(p.ray, p.hit, surface, p.vertexStart)) {
        passHit(p.ray, p.hit);
        next = kCross;
    } else if (p.segment.shadow) {
        if (miss) gain = p.pending * p.segment.weight;
        next = kFlight;
    } else if (miss) {
        if (hasEnvironment) addEnvironment(p, gain);
    } else if (hasSurfaces) {
        vertex = surfaceVertex(p, surface, shape, gain);
    }
    addRadiance(p, gain);
    return next;
}

// Handles what tracking ended with.
uint handleEvent(inout Path p, inout DirectLight light, inout uvec2 shadowExponential, inout Counts counts) {
    Vertex vertex;
    vertex.scatters = false;
    uint next = kContinue;
    counts.tests += hasStars ? kMaxStarsPerCell + 1u : 0u;  // of addEnvironment
    if (p.segment.state == kArrived) next = arrive(p, vertex);
    if (hasMedia && p.segment.state == kRouletted) next = kFlight;
    if (hasMedia && p.segment.state == kCollided) vertex = mediumVertex(p);
    if (vertex.scatters) next = scatter(p, vertex, light, shadowExponential, counts);
    return next;
}

#endif
