// The loop of the path tracing kernel, its film and its counters.
// Shader only: the reference's loop over samples is that of its renderer.
#ifndef INTEGRATOR_PATH_KERNEL_GLSL
#define INTEGRATOR_PATH_KERNEL_GLSL

#include "integrator/path_tracer.glsl"

layout(push_constant, scalar) uniform Push { PathArguments arguments; };
layout(set = 0, binding = 12, scalar) buffer FilmBlock { FilmPixel film[]; };
layout(set = 0, binding = 14, scalar) buffer CounterBlock { uint counters[]; };

// Shader only: groups are dealt out so that the first and the second half of the list, which the
// driver gives to different threads, cost the same.
uint laneIndex() {
    uint groups = gl_NumWorkGroups.x, half_ = (groups + 1u) / 2u, group = gl_WorkGroupID.x;
    uint dealt = group < half_ ? 2u * group : 2u * (group - half_) + 1u;
    return dealt * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}

// Shader only: pixel of a lane, in the crop. Groups are 8 x 8 pixels, each run of 8 or 16 lanes a compact block,
// where the crop's width allows it; rows otherwise.
uvec2 lanePixel(uint lane) {
    uint index = arguments.firstPixel + lane, width = arguments.cropSize.x;
    uint perBand = 8u * width, band = index / perBand, rest = index % perBand;
    uint rows = min(8u, arguments.cropSize.y - 8u * band);
    uint tile = rest / 64u, l = rest % 64u;
    uvec2 inTile = uvec2((l & 3u) | ((l >> 2u) & 4u), ((l >> 2u) & 3u) | ((l >> 3u) & 4u));
    bool tiled = rows == 8u && width % 8u == 0u;
    uvec2 blocked = uvec2(8u * tile, 8u * band) + inTile;
    return tiled ? blocked : uvec2(rest % width, 8u * band + rest / width);
}

// Shader only: adds a lane's share to a counter, one atomic a subgroup.
void count(uint counter, uint value) {
    uint sum = subgroupAdd(value);
    if (subgroupElect() && sum > 0u) atomicAdd(counters[counter], sum);
}

// Shader only: adds a finished path to the film; what is not a number counts as zero and is reported.
void finishPath(inout Path p, inout FilmPixel pixel, inout uvec3 anomalies) {
    bool bad = any(isnan(p.radiance)) || any(isinf(p.radiance));
    bool negative = any(lessThan(p.radiance, vec3(0.0)));
    anomalies += uvec3(1u, bad ? 1u : 0u, negative && !bad ? 1u : 0u);
    accumulate(pixel, bad ? vec3(0.0) : p.radiance);
    ++p.sampleIndex;
}

// Shader only: the twin's nested loops are tracePath.
void tracePixel(uint lane) {
    loadScene();
    uvec2 pixel = arguments.cropOffset + lanePixel(lane);
    uvec2 inCrop = pixel - arguments.cropOffset;
    uint filmIndex = inCrop.y * arguments.cropSize.x + inCrop.x;
    uint pixelIndex = pixel.y * arguments.filmSize.x + pixel.x;
    FilmPixel sums = film[filmIndex];
    Counts counts = Counts(0u, 0u, 0u, 0u, 0u, true);
    uvec3 anomalies = uvec3(0u);
    Path p;
    bool restart = arguments.restart != 0u;
    if (!restart) loadPath(lane, arguments.laneCount, p);
    if (restart) p.sampleIndex = 0u;
    keyPath(p, pixelIndex, arguments);
    uint next = restart ? kBegin : kContinue;
    while (p.sampleIndex < arguments.sampleCount && counts.tests < arguments.loopBudget) {
        DirectLight light = DirectLight(vec3(0.0), vec3(0.0, 0.0, 1.0), kInfinity, kNone, 1.0);
        uvec2 shadowExponential = uvec2(0u);
        if (hasMedia && next == kContinue) trackSegment(p, counts);
        if (next == kContinue) next = handleEvent(p, light, shadowExponential, counts);
        if (next == kFinish) finishPath(p, sums, anomalies);
        if (next == kFinish || next == kBegin) {
            startPath(p, pixelIndex, pixel, arguments);
            next = kFlight;
        }
        if (next == kFlight || next == kShadow) startRay(p, next == kShadow, light, shadowExponential);
        startSegment(p, next != kContinue, counts);
        next = kContinue;
        ++counts.tests;
    }
    film[filmIndex] = sums;
    bool unfinished = p.sampleIndex < arguments.sampleCount;
    savePath(lane, arguments.laneCount, p);
    count(kCounterPathsFinished, anomalies.x);
    count(kCounterNonFinite, anomalies.y);
    count(kCounterNegative, anomalies.z);
    count(kCounterMajorantViolations, counts.violations);
    count(kCounterBvhOverflow, counts.traversalsOk ? 0u : 1u);
    count(kCounterLoopTruncated, unfinished && counts.tests < arguments.loopBudget ? 1u : 0u);
    count(kCounterSteps, counts.steps);
    count(kCounterCollisions, counts.collisions);
    count(kCounterVertices, counts.vertices);
    count(kCounterActiveLanes, unfinished ? 1u : 0u);
}

#endif
