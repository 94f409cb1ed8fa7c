// The path tracer as a flat event loop: each turn, a lane tracks a few steps through its medium, then
// handles one event (a boundary, a vertex, the end of a shadow ray, the end of a path and the start of
// the next), then finds the next segment. Every lane runs every part, whatever its own state: the
// driver's vector units have no branches (README, "The path").
#ifndef INTEGRATOR_PATH_TRACER_GLSL
#define INTEGRATOR_PATH_TRACER_GLSL

#include "integrator/camera.glsl"
#include "integrator/direct_lighting.glsl"
#include "integrator/film.glsl"
#include "integrator/path_state.glsl"

struct Counts {
    uint tests;        // loop-back tests spent by this subgroup
    uint steps;
    uint violations;
    uint vertices;
    uint collisions;
    bool traversalsOk;
};

// Shader only: the reference refers to media.
Medium mediumAt(uint index) {
    if (!hasManyMedia) return nearMedium;
    return scene.media[min(index, kMaxMedia - 1u)];
}

// Throughput with the weight of spectral MIS: balance heuristic over the three hero channels.
// Shader only: within addEmission and scatter in the reference.
vec3 spectralBeta(Path p) {
    if (!hasChromaticExtinction) return p.beta;
    vec3 r = p.segment.ratio;
    return p.beta * (r / ((r.x + r.y + r.z) / 3.0));
}

// What a lane's event asks for next.
const uint kContinue = 0u;  // still tracking
const uint kCross = 1u;     // the same ray goes on behind a boundary
const uint kFlight = 2u;    // a new flight leaves the vertex
const uint kShadow = 3u;    // a shadow ray leaves the vertex
const uint kFinish = 4u;    // the path is complete
const uint kBegin = 5u;     // the window's first path

// Sends the flight or the shadow ray off from the vertex.
// Shader only: spawnRay in the reference, which has a ray for flights and one for shadows.
void startRay(inout Path p, bool shadow, DirectLight light, uvec2 shadowExponential) {
    vec3 direction = shadow ? light.direction : p.nextDirection;
    uvec2 word = shadow ? shadowExponential : p.nextExponential;
    float side = dot(p.vertexOffset, direction) < 0.0 ? -1.0 : 1.0;
    vec3 origin = hasTriangles ? p.vertexPosition + side * p.vertexOffset : p.vertexPosition;
    p.ray = newRay(origin, direction, shadow ? light.distance : kInfinity, p.vertexLast, shadow ? light.target : kNone,
                   p.vertexInside, p.vertexSlack);
    p.segment.shadow = shadow;
    p.segment.residual = exponential(word.x, word.y);
    p.segment.collisions = 0u;
    p.segment.weight = vec3(1.0);
    p.segment.threshold = light.threshold;
}

// Names the path of the next sample.
void keyPath(inout Path p, uint pixelIndex, PathArguments arguments) {
    uint low = arguments.sampleLow + p.sampleIndex;
    uint high = arguments.sampleHigh + (low < arguments.sampleLow ? 1u : 0u);
    p.stream = streamOf(pixelIndex, low, high, arguments.seed);
}

// Shader only: the reference's vertices begin so.
void leaveNoSurface(inout Path p) {
    p.vertexStart = Start(Face(vec3(0.0), vec3(0.0), vec3(0.0)), vec2(0.0));
    p.vertexOffset = vec3(0.0);
    p.vertexSlack = -1.0;
}

// Puts a new path on the camera, ready for its first flight.
void startPath(inout Path p, uint pixelIndex, uvec2 pixel, PathArguments arguments) {
    keyPath(p, pixelIndex, arguments);
    uvec4 word = drawStratified(p.stream, 0u, kDrawCamera);
    p.segment.hero = min(uint(3.0 * toUniform(word.w)), 2u);
    p.segment.ratio = vec3(1.0);
    p.vertex = 0u;
    p.beta = vec3(1.0);
    p.radiance = vec3(0.0);
    p.lastPdf = kInfinity;
    p.nextDirection = cameraDirection(filmPosition(pixel, vec2(toUniform(word.x), toUniform(word.y))));
    p.nextExponential = uvec2(word.z, spareBits(word.x, word.y, word.w));
    p.vertexPosition = vec3(0.0);
    leaveNoSurface(p);
    p.vertexInside = camera.inside;
    p.vertexLast = kNone;
}

// Finds what ends the ray's next segment and readies its tracking.
// Shader only: the reference loops over segments in fly and estimateTransmittance.
void startSegment(inout Path p, bool starts, inout Counts counts) {
    bool ok = true;
    Hit hit = closestHit(p.ray, starts, counts.tests, ok);
    counts.traversalsOk = counts.traversalsOk && (ok || !starts);
    if (!starts) return;
    // Nothing ahead although inside: a mesh boundary was missed within rounding; it has been left.
    if (hasTriangles && hit.primitive == kNone && isinf(hit.t)) p.ray.inside = kNone;
    if (hasTriangles && hasMedia) p.ray.inside = noticeEntry(p.ray, hit);
    p.hit = hit;
    p.segment.t = p.ray.tMin;
    p.segment.end = hit.t;
    p.segment.state = kArrived;
    uint index = hasMedia ? interiorOf(p.ray.inside) : kNone;
    if (hasMedia && index != kNone) {
        Medium medium = mediumAt(index);
        p.segment.state = kTracking;
        p.segment.cell = ivec3(0);
        if (hasHeterogeneousMedia && (medium.flags & kMediumHomogeneous) == 0u) {
            vec2 interval = gridInterval(medium, p.ray.origin, p.ray.direction);
            p.segment.t = max(p.ray.tMin, interval.x);
            p.segment.end = min(hit.t, interval.y);
            p.segment.state = p.segment.t < p.segment.end ? kTracking : kArrived;
            p.segment.cell = startCell(medium, p.ray.origin, p.ray.direction, p.segment.t);
        }
        if (hasHomogeneousMedia) stepAnalytically(p.segment, medium);
    }
}

// Tracks up to stepsPerEvent events through the medium.
// Shader only: trackFlight and trackShadow in the reference.
void trackSegment(inout Path p, inout Counts counts) {
    uint index = hasManyMedia ? interiorOf(p.ray.inside) : 0u;
    Medium medium = mediumAt(index);
    GridRay ray;
    if (hasHeterogeneousMedia) ray = gridRay(medium, p.ray.origin, p.ray.direction, p.segment.cell);
    for (uint i = 0u; i < stepsPerEvent && p.segment.state == kTracking; ++i) {
        uint before = p.segment.collisions;
        stepSegment(p.segment, medium, ray, p.stream.key, p.vertex, counts.violations);
        ++counts.steps;
        counts.collisions += p.segment.collisions - before;
    }
    counts.tests += stepsPerEvent + 1u;
}

#include "integrator/vertex.glsl"

#endif
