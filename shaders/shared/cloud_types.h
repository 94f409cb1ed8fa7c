// A procedural cloud: the field that is baked into a density grid.
#ifndef PARHELION_SHARED_CLOUD_TYPES_H
#define PARHELION_SHARED_CLOUD_TYPES_H

#include "language.h"

SHARED_BEGIN

// Parameters of a density field over the unit cube. `r`, the reference length, is 1/2: half the cube's edge.
struct CloudField {
    float detailAmount;
    float noiseScale;
    float warpAmount;
    float erosionAmount;
    float surfaceWidth;
    float densityScale;
    float densityThreshold;  // densities below it are empty
    uint noiseSeed;
    uvec3 resolution;        // voxels per axis of the grid it is baked into
    uint modulates;          // 1: erodes a given density instead of displacing a surface
};
SHARED_LAYOUT(CloudField, 48);

SHARED_END

#endif
