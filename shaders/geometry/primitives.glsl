// Analytic primitives: parallelogram, and the convex sphere and box that give an interval.
#ifndef GEOMETRY_PRIMITIVES_GLSL
#define GEOMETRY_PRIMITIVES_GLSL

#include "core/math.glsl"
#include "shared/scene_types.h"

const vec2 kEmptyInterval = vec2(1.0, -1.0);

// Bound of the error of intersectQuad's t, where the origin itself is uncertain by `slack`: 5 roundings of the distance
// from the plane, over the cosine.
float quadDistanceError(Quad quad, vec3 origin, vec3 direction, float slack) {
    float depth = 2.98023224e-7 * dot(abs(quad.normal), abs(quad.corner - origin)) + slack;
    return depth / abs(dot(direction, quad.normal));
}

// Distance along the ray, or -1 where it misses or runs in the plane. What misses by no more than u and v may be off by is
// a hit: no ray slips between quads that share an edge (H47).
float intersectQuad(Quad quad, vec3 origin, vec3 direction) {
    vec3 toCorner = quad.corner - origin;
    float t = dot(toCorner, quad.normal) / dot(direction, quad.normal);
    vec3 way = direction * t, p = way - toCorner;
    vec2 uv = vec2(dot(quad.uFromWorld, p), dot(quad.vFromWorld, p));
    vec3 terms = abs(way) + abs(toCorner) + abs(quad.corner);
    vec2 ahead = abs(vec2(dot(quad.uFromWorld, direction), dot(quad.vFromWorld, direction)));
    vec2 error = 2.98023224e-7 * vec2(dot(abs(quad.uFromWorld), terms), dot(abs(quad.vFromWorld), terms)) +
                 quadDistanceError(quad, origin, direction, 0.0) * ahead;
    vec2 beyond = max(-uv, uv - 1.0) - error;  // NaN for a ray in the plane
    return max(beyond.x, beyond.y) <= 0.0 && abs(t) < kInfinity ? t : -1.0;
}

// Entry and exit distance, either sign; kEmptyInterval where the line misses. The discriminant comes
// from the perpendicular component, which does not cancel for distant spheres (PBR4 6.8.2).
vec2 sphereInterval(vec3 center, float radius, vec3 origin, vec3 direction) {
    vec3 toCenter = center - origin;
    float along = dot(toCenter, direction);
    vec3 perpendicular = toCenter - along * direction;
    float square = radius * radius - dot(perpendicular, perpendicular);
    float halfChord = sqrt(max(square, 0.0));
    return square < 0.0 ? kEmptyInterval : vec2(along - halfChord, along + halfChord);
}

// The same for the image of [-1, 1]^3. An axis along which the ray does not move limits nothing
// inside and misses outside (H39).
vec2 boxInterval(mat4x3 localFromWorld, vec3 origin, vec3 direction) {
    vec3 o = localFromWorld * vec4(origin, 1.0);
    vec3 d = mat3(localFromWorld) * direction;
    vec3 inverse = 1.0 / d;
    vec3 a = (-1.0 - o) * inverse;
    vec3 b = (1.0 - o) * inverse;
    bvec3 still = equal(d, vec3(0.0));
    vec3 entry = mix(min(a, b), vec3(-kInfinity), still);
    vec3 exit = mix(max(a, b), vec3(kInfinity), still);
    float t0 = max(entry.x, max(entry.y, entry.z));
    float t1 = min(exit.x, min(exit.y, exit.z));
    bool misses = any(greaterThan(mix(vec3(0.0), abs(o), still), vec3(1.0))) || t1 < t0;
    return misses ? kEmptyInterval : vec2(t0, t1);
}

#endif
