// Compensated accumulation (Kahan): a million equal samples must not drift (H77, H80).
#ifndef INTEGRATOR_FILM_GLSL
#define INTEGRATOR_FILM_GLSL

#include "shared/path_types.h"

// Adds `value` to sum = high + low.
void addCompensated(inout vec2 high, inout vec2 low, vec2 value) {
    precise vec2 y = value + low;
    precise vec2 t = high + y;
    precise vec2 taken = t - high;
    precise vec2 rest = y - taken;
    high = t;
    low = rest;
}

void addCompensated(inout vec3 high, inout vec3 low, vec3 value) {
    precise vec3 y = value + low;
    precise vec3 t = high + y;
    precise vec3 taken = t - high;
    precise vec3 rest = y - taken;
    high = t;
    low = rest;
}

// Whether the film can hold a sample and its square: a number, and not too large.
bool fitsFilm(vec3 radiance) { return all(lessThan(abs(radiance), vec3(kLargestSample))); }

// Rec. 709.
float luminance(vec3 radiance) {
    precise float sum = 0.2126 * radiance.x + 0.7152 * radiance.y;
    precise float all = sum + 0.0722 * radiance.z;
    return all;
}

// Adds a sample; `first`: to an empty pixel.
void accumulate(inout FilmPixel pixel, vec3 radiance, bool first) {
    addCompensated(pixel.sumHigh, pixel.sumLow, radiance);
    addCompensated(pixel.squareHigh, pixel.squareLow, radiance * radiance);
    float y = luminance(radiance);
    pixel.pivot = first ? y : pixel.pivot;
    precise float d = y - pixel.pivot, square = d * d, cube = square * d, fourth = square * square;
    addCompensated(pixel.powerHigh, pixel.powerLow, vec2(d, square));
    pixel.third += cube;
    pixel.fourth += fourth;
    pixel.largest = max(pixel.largest, y);
}

#endif
