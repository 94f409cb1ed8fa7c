// The loop of the path tracing kernel, its film and its counters.
// Shader only: the reference's loop over samples is that of its renderer.
#ifndef INTEGRATOR_PATH_KERNEL_GLSL
#define INTEGRATOR_PATH_KERNEL_GLSL

#include "integrator/counters.glsl"
#include "integrator/lanes.glsl"
#include "integrator/path_tracer.glsl"

layout(set = 0, binding = 12, scalar) buffer FilmBlock { FilmPixel film[]; };

// Shader only: adds a finished path to the film; what that cannot hold counts as zero and is reported.
void finishPath(inout Path p, inout FilmPixel pixel, inout uvec3 anomalies) {
    bool bad = !fitsFilm(p.radiance);
    bool negative = any(lessThan(p.radiance, vec3(0.0)));
    anomalies += uvec3(1u, bad ? 1u : 0u, negative && !bad ? 1u : 0u);
    accumulate(pixel, bad ? vec3(0.0) : p.radiance, arguments.emptyFilm != 0u && p.sampleIndex == 0u);
    ++p.sampleIndex;
}

// Shader only: what a lane carries through its loop.
struct Lane {
    Path path;
    FilmPixel film;
    Counts counts;
    uvec3 anomalies;   // samples, not finite, negative
    Place place;
};

// Shader only: counts the turns that a path spends at one point of a ray. A distance that is no number is no progress.
void noteProgress(inout Path p, bool newRay, float before) {
    p.stalledTurns = newRay || p.segment.t > before ? 0u : p.stalledTurns + 1u;
}

// Shader only: whether a path has spent more turns at one point than any can need (README, "Paths that make no progress").
bool isStuck(Path p) { return p.stalledTurns > arguments.stallLimit; }

// Shader only: one turn: track, handle an event, find the next segment.
void turn(inout Lane lane, uint next) {
    DirectLight light = DirectLight(vec3(0.0), vec3(0.0, 0.0, 1.0), kInfinity, kNone, 1.0);
    uvec2 shadowExponential = uvec2(0u);
    float before = lane.path.segment.t;
    if (hasMedia && next == kContinue) trackSegment(lane.path, lane.counts);
    if (next == kContinue) next = handleEvent(lane.path, light, shadowExponential, lane.counts);
    if (next == kFinish) finishPath(lane.path, lane.film, lane.anomalies);
    if (next == kFinish || next == kBegin) {
        startPath(lane.path, lane.place.pixelIndex, lane.place.pixel, arguments);
        next = kFlight;
    }
    if (next == kFlight || next == kShadow) startRay(lane.path, next == kShadow, light, shadowExponential);
    startSegment(lane.path, next != kContinue, lane.counts);
    noteProgress(lane.path, next == kFlight || next == kShadow, before);
    ++lane.counts.tests;
}

// Shader only: names the first path that is stuck.
void reportStuck(Lane lane) {
    if (atomicAdd(counters[kCounterStuck], 1u) > 0u) return;
    counters[kCounterStuckX] = lane.place.pixel.x;
    counters[kCounterStuckY] = lane.place.pixel.y;
    counters[kCounterStuckSample] = lane.path.sampleIndex;
}

// Shader only: adds up what the lane counted, `goal` being the samples it was to have. What control pixels do is not in
// the image; what must not happen, must not happen there either.
void report(Lane lane, uint goal) {
    bool unfinished = lane.path.sampleIndex < goal, stuck = isStuck(lane.path);
    uint inImage = lane.place.isControl ? 0u : 1u;
    count(kCounterPathsFinished, lane.anomalies.x * inImage);
    count(kCounterNonFinite, lane.anomalies.y * inImage);
    count(kCounterNegative, lane.anomalies.z * inImage);
    count(kCounterMajorantViolations, lane.counts.violations);
    count(kCounterBvhOverflow, lane.counts.traversalsOk ? 0u : 1u);
    count(kCounterLoopTruncated, unfinished && !stuck && lane.counts.tests < arguments.loopBudget ? 1u : 0u);
    count(kCounterSteps, lane.counts.steps * inImage);
    count(kCounterCollisions, lane.counts.collisions * inImage);
    count(kCounterVertices, lane.counts.vertices * inImage);
    count(kCounterActiveLanes, unfinished ? 1u : 0u);
    if (stuck) reportStuck(lane);
}

// Shader only: the twin's nested loops are tracePath.
void tracePixel(uint laneId) {
    loadScene();
    Lane lane;
    lane.place = placeOf(laneId);
    uint filmIndex = lane.place.filmIndex;
    lane.film = film[filmIndex];
    firstLayer = filmIndex * depthLayers;
    lane.counts = Counts(0u, 0u, 0u, 0u, 0u, true);
    lane.anomalies = uvec3(0u);
    bool restart = arguments.restart != 0u;
    if (!restart) loadPath(filmIndex, arguments.laneCount, lane.path);
    if (restart) {
        lane.path.sampleIndex = 0u;
        lane.path.segment.t = 0.0;
        lane.path.stalledTurns = 0u;
    }
    keyPath(lane.path, lane.place.pixelIndex, arguments);
    uint next = restart ? kBegin : kContinue;
    bool pauses = lane.path.sampleIndex < arguments.pauseAt;
    uint goal = pauses ? min(arguments.pauseAt, arguments.sampleCount) : arguments.sampleCount;
    while (lane.path.sampleIndex < goal && lane.counts.tests < arguments.loopBudget && !isStuck(lane.path)) {
        turn(lane, next);
        next = kContinue;
    }
    film[filmIndex] = lane.film;
    savePath(filmIndex, arguments.laneCount, lane.path);
    report(lane, goal);
}

#endif
