// Diffuse reflection about the shading normal. Values leave the reflectance out: the path's
// throughput already holds it.
#ifndef SURFACE_BSDF_GLSL
#define SURFACE_BSDF_GLSL

#include "core/frame.glsl"
#include "core/math.glsl"
#include "sampling/warp.glsl"

// f * cos / reflectance, per steradian; 0 behind the surface.
float evalDiffuse(vec3 normal, vec3 wi) { return max(dot(normal, wi), 0.0) * kInvPi; }

// Direction in the frame of the normal, with density cos / pi.
vec3 sampleDiffuse(vec2 u) { return cosineHemisphere(u); }

float pdfDiffuse(float cosine) { return max(cosine, 0.0) * kInvPi; }

#endif
