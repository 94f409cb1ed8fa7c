// The scene's closest hit, and the crossing of medium boundaries.
#ifndef GEOMETRY_INTERSECTION_GLSL
#define GEOMETRY_INTERSECTION_GLSL

#include "core/scene.glsl"
#include "core/unroll.glsl"
#include "core/math.glsl"
#include "geometry/bvh.glsl"
#include "geometry/flat.glsl"
#include "geometry/primitives.glsl"
#include "geometry/ray.glsl"
#include "geometry/surface.glsl"

// Whether `shape` is one of those that surround what is `inside`: their numbers are nested as they are (kShapeOrderShift).
bool surrounds(uint shape, uint inside) {
    if (!hasNestedMedia || inside == kNone) return shape == inside && shape != kNone;
    uint outer = shapeAt(shape).flags, inner = shapeAt(inside).flags >> kShapeOrderShift & kMaxBoundaries;
    return (outer >> kShapeOrderShift & kMaxBoundaries) <= inner && inner <= outer >> kShapeLastShift;
}

// The rule for convex primitives (README, "Rays"). `flags` are the shape's.
void hitConvex(inout Hit best, Ray ray, vec2 interval, uint primitive, uint shape, uint flags) {
    bool isNull = (flags & kShapeNull) != 0u;
    bool around = isNull && shape == ray.inside;
    bool ahead = interval.x + interval.y > 2.0 * ray.tMin;
    bool own = primitive == ray.last;
    float opaque = interval.x >= ray.tMin && !own ? interval.x : interval.y;
    bool candidate = interval.y >= interval.x && interval.y > ray.tMin && primitive != ray.target;
    bool enters = candidate && (isNull ? ahead && !surrounds(shape, ray.inside) : ahead || !own);
    float t = around ? max(interval.y, ray.tMin) : (isNull ? max(interval.x, ray.tMin) : opaque);
    if ((around || enters) && t < ray.tMax) keepNearer(best, Hit(t, primitive, vec2(0.0), around, false));
}

// Shader only: within closestHit in the reference.
void hitQuad(inout Hit best, Ray ray, Quad quad, uint primitive) {
    float t = intersectQuad(quad, ray.origin, ray.direction);
    float error = t == -1.0 ? 0.0 : quadDistanceError(quad, ray.origin, ray.direction, max(ray.slack, 0.0));
    hitFlat(best, ray, t, error, primitive, vec2(0.0));
}

// Shader only: as above.
void hitSphere(inout Hit best, Ray ray, Sphere sphere, uint primitive) {
    vec2 interval = sphereInterval(sphere.center, sphere.radius, ray.origin, ray.direction);
    hitConvex(best, ray, interval, primitive, sphere.shape, sphere.flags);
}

// Shader only: as above.
void hitBox(inout Hit best, Ray ray, Box box, uint primitive) {
    vec2 interval = boxInterval(box.localFromWorld, ray.origin, ray.direction);
    hitConvex(best, ray, interval, primitive, box.shape, box.flags);
}

// First hit in [tMin, tMax) for lanes that are `active_`. Sets ok to false when a traversal was cut short.
Hit closestHit(Ray ray, bool active_, inout uint tests, inout bool ok) {
    Hit best = Hit(ray.tMax, kNone, vec2(0.0), false, false);
#define NEAR_QUAD(i) hitQuad(best, ray, nearQuads[i], i);
#define FAR_QUAD(i) hitQuad(best, ray, scene.quads[i], i);
#define NEAR_SPHERE(i) hitSphere(best, ray, nearSpheres[i], quadCount + i);
#define FAR_SPHERE(i) hitSphere(best, ray, scene.spheres[i], quadCount + i);
#define NEAR_BOX(i) hitBox(best, ray, nearBoxes[i], quadCount + sphereCount + i);
#define FAR_BOX(i) hitBox(best, ray, scene.boxes[i], quadCount + sphereCount + i);
    if (hasQuads) { FOR_EACH(quadCount, NEAR_QUAD, FAR_QUAD) }
    if (hasSpheres) { FOR_EACH(sphereCount, NEAR_SPHERE, FAR_SPHERE) }
    if (hasBoxes) { FOR_EACH(boxCount, NEAR_BOX, FAR_BOX) }
    tests += quadCount + sphereCount + boxCount + 3u;
    if (hasTriangles)
        ok = traverse(best, ray, quadCount + sphereCount + boxCount, active_ && triangleCount > 0u, tests) && ok;
    return best;
}

// `inside` of a ray whose first hit is `hit`: a ray from a surface in a mesh's boundary may start beyond it.
uint noticeEntry(Ray ray, Hit hit) {
    uint index = hit.primitive - (quadCount + sphereCount + boxCount);
    bool isTriangle = hit.primitive != kNone && index < triangleCount && !hit.near;
    int texel = int(kTriangleTexels * (isTriangle ? index : 0u));
    vec4 a = texelFetch(triangleTexels, texel);
    vec3 b = texelFetch(triangleTexels, texel + 1).xyz, c = texelFetch(triangleTexels, texel + 2).xyz;
    uint shape = isTriangle ? floatBitsToUint(a.w) : 0u;
    bool isNull = isTriangle && (shapeAt(shape).flags & kShapeNull) != 0u;
    bool starts = ray.last != kNone && ray.tMin == 0.0 && !surrounds(shape, ray.inside);
    return isNull && starts && dot(ray.direction, cross(b - a.xyz, c - a.xyz)) > 0.0 ? shape : ray.inside;
}

// The ray goes on behind what it has met.
void passHit(inout Ray ray, Hit hit) {
    bool isFlat = isFlatPrimitive(hit.primitive);
    ray.passed = isFlat ? hit.primitive + 1u : (hit.t > ray.tMin ? 0u : ray.passed);
    ray.tMin = hit.t;
}

// Takes the ray across the null boundary it has met (README, "inside").
void crossBoundary(inout Ray ray, Hit hit, uint shapeIndex, uint exterior, vec3 geometricNormal) {
    bool enters = isFlatPrimitive(hit.primitive) ? dot(ray.direction, geometricNormal) < 0.0 : !hit.exits;
    bool within = hit.exits || surrounds(shapeIndex, ray.inside);
    uint event = 2u * (shapeIndex + 1u) + (enters ? 1u : 0u);
    bool cancels = (ray.idle ^ event) == 1u && hit.t - ray.idleT <= kCoincidence * hit.t;
    bool changes = enters != within && !cancels;
    ray.idle = enters == within ? event : (cancels ? 0u : ray.idle);
    ray.idleT = enters == within ? hit.t : ray.idleT;
    if (changes) ray.inside = enters ? shapeIndex : exterior;
    passHit(ray, hit);
}

#endif
