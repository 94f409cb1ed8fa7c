// Which pixel a lane renders, and with which samples.
// Shader only: the reference loops over the pixels of the image and over its control pixels.
#ifndef INTEGRATOR_LANES_GLSL
#define INTEGRATOR_LANES_GLSL

#include "shared/path_types.h"

layout(set = 0, binding = 28, scalar) readonly buffer ArgumentBlock { PathArguments submitted; };
layout(set = 0, binding = 29, scalar) readonly buffer ControlBlock { uint controlPixels[]; };  // in crop order

PathArguments arguments = submitted;

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

// What a lane renders.
struct Place {
    uvec2 pixel;      // on the whole film
    uint pixelIndex;  // of it there
    uint filmIndex;   // where it stands in its batch's film, which has the control pixels, run after run, at its end
    bool isControl;
};

// Shader only: also gives control lanes samples of their own.
Place placeOf(uint lane) {
    bool isControl = lane >= arguments.imageLanes;
    uvec2 inCrop = lanePixel(lane);
    uint filmIndex = inCrop.y * arguments.cropSize.x + inCrop.x - arguments.firstPixel;
    if (isControl) {
        uint control = lane - arguments.imageLanes, crop = controlPixels[control / kControlRuns];
        inCrop = uvec2(crop % arguments.cropSize.x, crop / arguments.cropSize.x);
        filmIndex = lane;
        arguments.sampleHigh |= (control % kControlRuns + 1u) << kControlShift;
    }
    uvec2 pixel = arguments.cropOffset + inCrop;
    return Place(pixel, pixel.y * arguments.filmSize.x + pixel.x, filmIndex, isControl);
}

#endif
