// Gradient sky with stars (README, "Sky").
#ifndef LIGHT_SKY_GLSL
#define LIGHT_SKY_GLSL

#include "core/frame.glsl"
#include "core/scene.glsl"
#include "sampling/distribution.glsl"
#include "sampling/sampler.glsl"
#include "sampling/warp.glsl"

// base^power for base in [0, 1] and power >= 0, given 1 - base as well; 0^0 = 1. The error is at most 2^-22 whatever the
// power: that of an exponent x is relative, and x exp(x) is bounded.
float unitPower(float base, float complement, float power) {
    precise float next = 1.0 - complement;
    precise float lost = (next - 1.0) + complement;  // what rounding took; the slope of log may pass for 1
    float logarithm = base < 0.5 ? logPositive(max(base, 1.2e-38)) : logPositive(next) - lost;
    float result = base > 0.0 ? expNegative(power * logarithm) : 0.0;
    result = power == 1.0 ? base : result;
    return power == 0.0 ? 1.0 : result;
}

vec3 skyGradient(vec3 d) {
    bool below = dot(d, sky.axis) < 0.0;
    vec3 chord = below ? d + sky.axis : d - sky.axis;
    float small = 0.25 * dot(chord, chord);
    float raw = below ? small : 1.0 - small, rest = below ? 1.0 - small : small;  // t_raw and 1 - t_raw
    float shift = 0.5 * (sky.width - 1.0);
    float base = clamp((raw + (shift + sky.offset)) / sky.width, 0.0, 1.0);
    float complement = clamp((rest + (shift - sky.offset)) / sky.width, 0.0, 1.0);
    if (sky.width == 0.0) {
        base = raw + sky.offset >= 0.5 ? 1.0 : 0.0;
        complement = 1.0 - base;
    }
    float t = unitPower(base, complement, sky.power);
    return (1.0 - t) * sky.bottom + t * sky.top;
}

// Index of the lookup cell that holds a direction.
uint starCell(vec3 d) {
    vec3 size = abs(d);
    uint axis = size.x >= size.y && size.x >= size.z ? 0u : size.y >= size.z ? 1u : 2u;
    vec3 turned = axis == 0u ? d.xyz : axis == 1u ? d.yzx : d.zxy;
    vec2 place = (0.5 + 0.5 * turned.yz / abs(turned.x)) * float(sky.starCells);
    uvec2 cell = min(uvec2(max(place, 0.0)), uvec2(max(sky.starCells, 1u) - 1u));
    uint face = 2u * axis + (turned.x < 0.0 ? 1u : 0u);
    return (face * sky.starCells + cell.y) * sky.starCells + cell.x;
}

// The star whose disc holds a direction, or kNone. Callers add kMaxStarsPerCell + 1 to their tests.
uint findStar(vec3 d) {
    uint run = texelFetch(starCells, int(starCell(d))).x;
    uint count = sky.starCells == 0u ? 0u : min(run & 15u, kMaxStarsPerCell);
    uint found = kNone;
    for (uint i = 0u; i < count; ++i) {
        uint star = texelFetch(starCells, int((run >> 4u) + i)).x;
        vec4 disc = texelFetch(starTexels, int(2u * star));
        vec3 chord = d - disc.xyz;
        found = dot(chord, chord) <= 2.0 * disc.w ? star : found;
    }
    return found;
}

// A direction and the star that holds it.
struct SkyPoint {
    vec3 direction;
    uint star;
};

vec3 skyRadiance(SkyPoint p) {
    vec3 radiance = skyGradient(p.direction);
    if (hasStars && p.star != kNone)
        radiance += texelFetch(starTexels, int(2u * p.star + 1u)).x * sky.starRadiance;
    return radiance;
}

// Density per steradian with which sampleSky finds the point.
float skyPdf(SkyPoint p) {
    float place = 0.5 * (dot(p.direction, sky.axis) + 1.0) * float(sky.bandCount);
    uint band = min(uint(max(place, 0.0)), max(sky.bandCount, 1u) - 1u);
    float pdf = texelFetch(skyBands, int(band)).x;
    if (hasStars && p.star != kNone) pdf += texelFetch(starTexels, int(2u * p.star + 1u)).y;
    return pdf;
}

// A point of the sky from the words of a light draw.
SkyPoint sampleSky(uvec3 words) {
    Choice choice = invertDistribution(sky.distribution, sky.bandCount + sky.starCount, words.x, fillDigits(words.z).x);
    vec2 u = vec2(choice.offset, toUniform(words.y));
    uint band = min(choice.entry, sky.bandCount - 1u);
    float height = 2.0 / float(sky.bandCount);
    float rise = (float(band) + u.x) * height;                               // 1 + cos
    float fall = (float(sky.bandCount - 1u - band) + choice.left) * height;  // 1 - cos
    vec2 sc = sinCosTurn(u.y);
    vec3 local = vec3(sqrt(rise * fall) * vec2(sc.y, sc.x), rise < fall ? rise - 1.0 : 1.0 - fall);
    vec3 axis = sky.axis;
    uint star = kNone;
    if (hasStars && choice.entry >= sky.bandCount) {
        star = choice.entry - sky.bandCount;
        vec4 disc = texelFetch(starTexels, int(2u * star));
        axis = disc.xyz;
        local = uniformCone(u, disc.w);
    }
    vec3 direction = normalize(toWorld(frameFromNormal(axis), local));
    if (hasStars && star == kNone) star = findStar(direction);
    return SkyPoint(direction, star);
}

#endif
