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
    uvec3 resolution;  // voxels per axis of the grid it is baked into
    uint modulates;    // 1: erodes a given density instead of displacing a surface
};
SHARED_LAYOUT(CloudField, 48);

// What a bake needs of a field, divisions done: only operations that every device rounds alike are left.
struct CloudArguments {
    vec3 frequency;   // noise cells along each axis of the cube
    float blend;      // 0: cube, 1: blob
    vec3 voxelSize;   // edge of a voxel in the unit cube
    float sharpness;  // 1 / surfaceWidth
    float detailAmount;
    float warpAmount;
    float erosionAmount;
    float densityScale;
    float densityThreshold;
    float inverseLargest;  // of the density that is modulated
    uint noiseSeed;
    uint modulates;
    uvec3 resolution;
    uint firstVoxel;  // of this dispatch, x fastest
    uint voxelCount;  // of this dispatch
};
SHARED_LAYOUT(CloudArguments, 84);

// The cube: half its edge is core + radius.
SHARED_CONST(float, kCloudBoxCore, 0.26f);
SHARED_CONST(float, kCloudBoxRadius, 0.08f);
// Mean of the detail without erosion.
SHARED_CONST(float, kCloudMeanDetail, 0.38f);

// Independent noises of one seed; an fBM takes one stream for each octave.
SHARED_CONST(uint, kCloudStreamWarp, 0u);
SHARED_CONST(uint, kCloudStreamBillow, 8u);
SHARED_CONST(uint, kCloudStreamCells, 16u);
SHARED_CONST(uint, kCloudStreamErosion, 24u);

SHARED_END

#endif
