// Warps of the unit square. The first coordinate sets the polar angle, the second the azimuth.
#ifndef SAMPLING_WARP_GLSL
#define SAMPLING_WARP_GLSL

#include "core/math.glsl"

// Unit vector about +z with density cos / pi.
vec3 cosineHemisphere(vec2 u) {
    vec2 sc = sinCosTurn(u.y);
    return vec3(sqrt(u.x) * vec2(sc.y, sc.x), sqrt(max(0.0, 1.0 - u.x)));
}

// Unit vector with density 1 / (4 pi).
vec3 uniformSphere(vec2 u) {
    vec2 sc = sinCosTurn(u.y);
    return vec3(2.0 * sqrt(u.x * (1.0 - u.x)) * vec2(sc.y, sc.x), 1.0 - 2.0 * u.x);
}

// Unit vector within a cone about +z, density 1 / (2 pi oneMinusCosMax). One minus the cosine is
// what stays accurate in narrow cones (H62).
vec3 uniformCone(vec2 u, float oneMinusCosMax) {
    vec2 sc = sinCosTurn(u.y);
    float c = oneMinusCosMax * u.x;
    return vec3(sqrt(c * (2.0 - c)) * vec2(sc.y, sc.x), 1.0 - c);
}

// Barycentric coordinates, uniform over a triangle (PBR3 13.6.5).
vec3 uniformTriangle(vec2 u) {
    float s = sqrt(u.x);
    float b1 = u.y * s;
    return vec3(1.0 - s, b1, s - b1);
}

#endif
