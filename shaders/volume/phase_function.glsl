// Phase functions. Directions point away from the vertex; mu = dot(-wo, wi), so E[mu] = g.
// evalPhase is also the density of samplePhase, per steradian.
#ifndef VOLUME_PHASE_FUNCTION_GLSL
#define VOLUME_PHASE_FUNCTION_GLSL

#include "core/math.glsl"

// Henyey-Greenstein from the squared distance of the unit directions: nothing cancels next to
// mu = +-1 (numerics H5). |g| <= 1 - 2^-20.
float evalHenyeyGreenstein(float g, vec3 wo, vec3 wi) {
    float a = abs(g);
    vec3 difference = g >= 0.0 ? wi + wo : wi - wo;
    float b = 1.0 - a;
    float square = b * b + a * dot(difference, difference);
    return kInvFourPi * b * (1.0 + a) / (square * sqrt(square));
}

// (mu, sinTheta, pdf). With 1 - mu and 1 + mu as products, every g and u in [0, 1) keeps full
// accuracy: relative error <= 1e-6 (numerics H1-H4).
vec3 sampleHenyeyGreenstein(float g, float u) {
    float a = abs(g);
    float v = g >= 0.0 ? u : 1.0 - u;
    float minus = 1.0 - a, plus = 1.0 + a;
    float k = minus + 2.0 * a * v;
    float inverse = 1.0 / k;
    float oneMinusMu = 2.0 * minus * minus * (1.0 - v) * (1.0 + a * v) * (inverse * inverse);
    float onePlusMu = 2.0 * plus * plus * v * (minus + a * v) * (inverse * inverse);
    float mu = oneMinusMu < 1.0 ? 1.0 - oneMinusMu : onePlusMu - 1.0;
    float pdf = kInvFourPi * k * k * k / ((minus * plus) * (minus * plus));
    return vec3(g >= 0.0 ? mu : -mu, sqrt(oneMinusMu * onePlusMu), pdf);
}

#endif
