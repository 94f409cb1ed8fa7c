#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "integrator/film.glsl"

void probeItem() {
    vec4 a = probeInput(0u);
    vec4 state[9];
    for (uint i = 1u; i < 9u; ++i) state[i] = probeInput(i);
    FilmPixel pixel = FilmPixel(state[1].xyz, state[2].xyz, state[3].xyz, state[4].xyz, state[6].xy, state[6].zw,
                                state[7].x, state[8].x, state[8].y, state[8].z);
    vec3 high = state[1].xyz, low = state[2].xyz, naive = state[5].xyz;
    bool first = state[8].w == 0.0;
    for (uint i = 0u; i < uint(a.w); ++i) {
        vec3 summand = a.xyz * float(1u + i % 3u);
        accumulate(pixel, summand, first && i == 0u);
        naive += summand;
    }
    addCompensated(high, low, a.xyz);
    probeOutput(0u, vec4(high, 0.0));
    probeOutput(1u, vec4(pixel.sumHigh, low.x));
    probeOutput(2u, vec4(pixel.sumLow, low.y));
    probeOutput(3u, vec4(pixel.squareHigh, low.z));
    probeOutput(4u, vec4(pixel.squareLow, 0.0));
    probeOutput(5u, vec4(naive, fitsFilm(a.xyz) ? 1.0 : 0.0));
    probeOutput(6u, vec4(pixel.powerHigh, pixel.powerLow));
    probeOutput(7u, vec4(pixel.third, 0.0, 0.0, luminance(a.xyz)));
    probeOutput(8u, vec4(pixel.fourth, pixel.pivot, pixel.largest, 1.0));
}
