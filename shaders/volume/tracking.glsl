// Null-collision tracking: free flights and transmittance share one step (README, "Tracking").
#ifndef VOLUME_TRACKING_GLSL
#define VOLUME_TRACKING_GLSL

#include "geometry/ray.glsl"
#include "sampling/sampler.glsl"
#include "volume/density.glsl"
#include "volume/majorant.glsl"

const uint kTracking = 0u;   // inside the segment
const uint kArrived = 1u;    // at the segment's end
const uint kCollided = 2u;   // a real collision (flights)
const uint kRouletted = 3u;  // the weight was terminated (shadow rays)

// A ray's way through one medium segment [t, end].
struct Segment {
    float t;
    float end;
    float residual;    // optical thickness, in majorants, to the next tentative collision
    uint collisions;   // tentative ones on this ray so far: index of the next draw
    ivec3 cell;
    uint state;
    bool shadow;
    uint hero;         // channel that decides flights in chromatic media
    float threshold;   // shadow roulette
    vec3 weight;       // shadow: transmittance estimate so far
    vec3 ratio;        // density of the path so far under each hero channel, up to a common factor
};

// Shader only: a member of the residual in the reference.
uint segmentPurpose(Segment s) { return (s.shadow ? kDrawShadow : kDrawFlight) | s.collisions << kDrawIndexShift; }

// Shader only: a member of the medium in the reference.
bool isHomogeneous(Medium medium) {
    return hasHomogeneousMedia && (!hasHeterogeneousMedia || (medium.flags & kMediumHomogeneous) != 0u);
}

// What a tentative collision does: q is the real share of the majorant, per channel, that of the hero
// density / bound.
void decideFlight(inout Segment s, vec3 q, float u, float density, float bound) {
    bool real = u * bound < density;
    if (hasChromaticExtinction) {
        s.ratio *= real ? q : 1.0 - q;
        // By what it has become: by the event's own largest share it would sink to 0 in all channels (H37).
        s.ratio *= safeDivide(1.0, maxComponent(s.ratio));
    }
    s.state = real ? kCollided : s.state;
}

void decideShadow(inout Segment s, vec3 q, float u) {
    s.weight *= 1.0 - q;
    float largest = hasChromaticExtinction ? maxComponent(s.weight) : s.weight.x;
    bool survives = u * s.threshold < largest;
    if (largest < s.threshold) {
        s.weight *= survives ? s.threshold / largest : 0.0;
        s.state = survives ? s.state : kRouletted;
    }
}

// Homogeneous media: the one cell has no planes, its density is the bound, and a shadow ray needs no
// collisions. Returns true where the analytic transmittance took the whole segment.
// Shader only: within trackShadow in the reference.
bool stepAnalytically(inout Segment s, Medium medium) {
    bool analytic = isHomogeneous(medium) && s.shadow;
    if (analytic) {
        float depth = medium.sigmaMax * (s.end - s.t);
        if (hasChromaticExtinction)
            s.weight *= vec3(expNegative(-depth * medium.sigmaRatio.x), expNegative(-depth * medium.sigmaRatio.y),
                             expNegative(-depth * medium.sigmaRatio.z));
        else
            s.weight *= expNegative(-depth);
        s.t = s.end;
        s.state = kArrived;
    }
    return analytic;
}

// One event: the next tentative collision, the next cell, or the end of the segment.
// Shader only: nextCollision and its loops in the reference.
void stepSegment(inout Segment s, Medium medium, GridRay ray, uvec2 key, uint vertex, inout uint violations) {
    bool homogeneous = isHomogeneous(medium);
    vec3 planes = vec3(kInfinity);
    float bound = 1.0;
    if (hasHeterogeneousMedia) {
        planes = homogeneous ? planes : planeDistances(ray, s.cell);
        bound = homogeneous ? bound : majorantAt(medium, s.cell);
    }
    float next = max(min(min(planes.x, planes.y), min(planes.z, s.end)), s.t);
    float majorant = medium.sigmaMax * bound;
    float depth = majorant * (next - s.t);
    bool collides = depth > s.residual;
    float t = collides ? min(s.t + s.residual / majorant, next) : next;
    uvec4 word = draw(key, vertex, segmentPurpose(s));
    vec3 densities = vec3(1.0);
    if (hasHeterogeneousMedia) {
        // Lanes that only change cells would fetch too, and miss the caches: they all read the first voxel.
        vec3 position = collides ? ray.origin + t * ray.direction : vec3(0.5);
        vec3 values = densityAt(medium, position, cornerOffsets(word));
        densities = homogeneous ? densities : values;
    }
    float density = hasColorDensity ? maxComponent(densities) : densities.x;
    s.t = t;
    if (collides) {
        violations += density > bound ? 1u : 0u;
        vec3 q = hasColorDensity ? densities / bound : vec3(density / bound);
        if (hasChromaticExtinction) q *= medium.sigmaRatio;
        if (hasChromaticExtinction) density = medium.sigmaRatio[s.hero] * densities[s.hero];
        float u = toUniform(word.x);
        if (s.shadow) decideShadow(s, q, u);
        else decideFlight(s, q, u, density, bound);
        s.residual = exponential(word.z, word.w >> 8u);
        ++s.collisions;
    } else {
        s.residual -= depth;
        s.state = next >= s.end ? kArrived : kTracking;
        if (hasHeterogeneousMedia) s.cell = next >= s.end ? s.cell : nextCell(ray, s.cell, planes);
    }
}

#endif
