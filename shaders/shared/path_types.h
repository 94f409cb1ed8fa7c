// Film, counters and arguments of the path tracing kernel, and the named random dimensions.
#ifndef PARHELION_SHARED_PATH_TYPES_H
#define PARHELION_SHARED_PATH_TYPES_H

#include "language.h"

SHARED_BEGIN

// A sample whose channels are not all below this is dropped and counted: its square would leave the range of float. 2^63
SHARED_CONST(float, kLargestSample, 9223372036854775808.0f);

// Sums over a pixel's samples; those in two parts are compensated: value = high + low (Kahan). 80 bytes a pixel.
struct FilmPixel {
    vec3 sumHigh;
    vec3 sumLow;
    vec3 squareHigh;  // of the squared samples, per channel
    vec3 squareLow;
    vec2 powerHigh;   // of d and d^2, d being a sample's luminance less `pivot`
    vec2 powerLow;
    float third;      // of d^3
    float fourth;     // of d^4
    float pivot;      // luminance of the pixel's first sample: where samples hardly differ, their powers would cancel
    float largest;    // luminance of the brightest sample
};
SHARED_LAYOUT(FilmPixel, 80);

// A film layer's share of a pixel: what paths of one number of scatterings bring. Layer k of pixel p is
// at p * SceneConstants.depthLayers + k.
struct LayerPixel {
    vec3 sumHigh;  // compensated, as FilmPixel's
    vec3 sumLow;
};
SHARED_LAYOUT(LayerPixel, 24);

// First surface hit along the primary ray, null surfaces excluded; media ignored. Sums over samples.
struct FeaturePixel {
    vec3 albedo;
    float depth;   // distance from the camera, scene units; 0 where nothing is hit
    vec3 normal;
    float hits;    // samples that hit a surface
};
SHARED_LAYOUT(FeaturePixel, 32);

// Counters of a dispatch, 64 bits each: the low words, then the high ones. The host adds them up after every dispatch and
// clears them.
SHARED_CONST(uint, kCounterPathsFinished, 0u);
SHARED_CONST(uint, kCounterNonFinite, 1u);          // samples dropped because the film cannot hold them: NaN, or 2^63 and more
SHARED_CONST(uint, kCounterMajorantViolations, 2u); // density above its cell's bound
SHARED_CONST(uint, kCounterBvhOverflow, 3u);        // traversals cut short: always an error
SHARED_CONST(uint, kCounterLoopTruncated, 4u);      // loop left without a reason: always an error
SHARED_CONST(uint, kCounterNegative, 5u);           // samples with a negative channel
SHARED_CONST(uint, kCounterSteps, 6u);              // tracking steps, for reports
SHARED_CONST(uint, kCounterCollisions, 7u);         // tentative collisions, for reports
SHARED_CONST(uint, kCounterVertices, 8u);           // real collisions and surface hits, for reports
SHARED_CONST(uint, kCounterActiveLanes, 9u);        // lanes that have samples left
SHARED_CONST(uint, kCounterStuck, 10u);             // paths that make no progress: always an error; of one of them:
SHARED_CONST(uint, kCounterStuckX, 11u);            // its pixel
SHARED_CONST(uint, kCounterStuckY, 12u);
SHARED_CONST(uint, kCounterStuckSample, 13u);       // its sample, within the window
SHARED_CONST(uint, kCounterCount, 16u);

// Turns that a path may spend at one point of a ray, beyond two for each null face of the scene (README, "Paths that make
// no progress").
SHARED_CONST(uint, kMaximumStall, 65536u);

// Control pixels are pixels of the image rendered again, kControlRuns times, each with random numbers of its own: run r
// takes the samples from (r + 1) << kControlShift in the high word of their index on, images those below: 2^40.
SHARED_CONST(uint, kControlRuns, 2u);
SHARED_CONST(uint, kControlShift, 8u);

// Random draws: four words from pcg4d(key.x, key.y, vertex, purpose). Vertex 0 is the camera. What tells purposes apart
// stands in their low bits: pcg4d carries differences upwards, and words of purposes that differ in their highest bits
// alone have most of their low bits in common.
SHARED_CONST(uint, kDrawCamera, 0u);
SHARED_CONST(uint, kDrawLight, 1u);
SHARED_CONST(uint, kDrawScatter, 2u);
SHARED_CONST(uint, kDrawAlbedo, 3u);
SHARED_CONST(uint, kDrawFeature, 4u);            // the feature pass's film position
SHARED_CONST(uint, kDrawFlight, 6u);             // | index of the tentative collision on this ray << kDrawIndexShift
SHARED_CONST(uint, kDrawShadow, 7u);             // | the same
SHARED_CONST(uint, kDrawIndexShift, 3u);

// A path saved between dispatches: kPathStateWords words, word w of the batch's pixel p at w * pixels + p. Word
// kPathSampleWord counts the samples that the pixel has in this window.
SHARED_CONST(uint, kPathStateWords, 70u);
SHARED_CONST(uint, kPathSampleWord, 0u);

struct PathArguments {
    uvec2 filmSize;      // whole film, pixels
    uvec2 cropOffset;    // first pixel rendered
    uvec2 cropSize;      // pixels rendered
    uint firstPixel;     // first lane's index in this batch, in crop order
    uint laneCount;      // lanes in this batch
    uint sampleLow;      // 64-bit index of the first sample of this window
    uint sampleHigh;
    uint sampleCount;    // samples per pixel in this window
    uint seed;
    uint loopBudget;     // loop-back tests a subgroup may spend in this dispatch
    uint restart;        // 1: lanes begin the window afresh; 0: they resume their saved path
    uint pauseAt;        // lanes with fewer samples stop at this many for the rest of the dispatch
    uint stallLimit;     // turns without progress after which a path is stuck
    uint imageLanes;     // of laneCount: the pixels of the image; the others render control pixels
    uint emptyFilm;      // 1: the film holds no samples before this window
};
SHARED_LAYOUT(PathArguments, 72);

SHARED_END

#endif
