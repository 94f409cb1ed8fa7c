#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "integrator/film.glsl"

void probeItem() {
    vec4 a = probeInput(0u);
    FilmPixel pixel = FilmPixel(probeInput(1u).xyz, probeInput(2u).xyz, probeInput(3u).xyz, probeInput(4u).xyz);
    vec3 high = probeInput(1u).xyz, low = probeInput(2u).xyz, naive = probeInput(5u).xyz;
    for (uint i = 0u; i < uint(a.w); ++i) {
        vec3 summand = a.xyz * float(1u + i % 3u);
        accumulate(pixel, summand);
        naive += summand;
    }
    addCompensated(high, low, a.xyz);
    probeOutput(0u, vec4(high, 0.0));
    probeOutput(1u, vec4(pixel.sumHigh, low.x));
    probeOutput(2u, vec4(pixel.sumLow, low.y));
    probeOutput(3u, vec4(pixel.squareHigh, low.z));
    probeOutput(4u, vec4(pixel.squareLow, 0.0));
    probeOutput(5u, vec4(naive, fitsFilm(a.xyz) ? 1.0 : 0.0));
}
