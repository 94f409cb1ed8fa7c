// The scene's closest hit, and the crossing of medium boundaries.
#ifndef GEOMETRY_INTERSECTION_GLSL
#define GEOMETRY_INTERSECTION_GLSL

#include "core/scene.glsl"
#include "core/unroll.glsl"
#include "core/math.glsl"
#include "geometry/bvh.glsl"
#include "geometry/primitives.glsl"
#include "geometry/ray.glsl"
#include "geometry/surface.glsl"

// Whether `shape` is one of those that surround what is `inside`. Eight deep at most.
bool surrounds(uint shape, uint inside) {
    uint around = inside;
    if (hasNestedMedia)
        for (uint i = 0u; i < 8u && around != kNone && around != shape; ++i) around = shapeAt(around).exterior;
    return around == shape && shape != kNone;
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
    if ((around || enters) && t < ray.tMax) keepNearer(best, Hit(t, primitive, vec2(0.0), around));
}

// Shader only: within closestHit in the reference.
void hitQuad(inout Hit best, Ray ray, Quad quad, uint primitive) {
    float t = intersectQuad(quad, ray.origin, ray.direction);
    if (t >= ray.tMin && t < ray.tMax && primitive != ray.last && primitive != ray.target)
        keepNearer(best, Hit(t, primitive, vec2(0.0), false));
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
    Hit best = Hit(ray.tMax, kNone, vec2(0.0), false);
#define NEAR_QUAD(i) hitQuad(best, ray, nearQuads[i], i);
#define FAR_QUAD(i) hitQuad(best, ray, scene.quads[i], i);
#define NEAR_SPHERE(i) hitSphere(best, ray, nearSpheres[i], quadCount + i);
#define FAR_SPHERE(i) hitSphere(best, ray, scene.spheres[i], quadCount + i);
#define NEAR_BOX(i) hitBox(best, ray, nearBoxes[i], quadCount + sphereCount + i);
#define FAR_BOX(i) hitBox(best, ray, scene.boxes[i], quadCount + sphereCount + i);
    if (hasQuads) { FOR_EACH(quadCount, NEAR_QUAD, FAR_QUAD) }
    if (hasSpheres) { FOR_EACH(sphereCount, NEAR_SPHERE, FAR_SPHERE) }
    if (hasBoxes) { FOR_EACH(boxCount, NEAR_BOX, FAR_BOX) }
    tests += quadCount + (sphereCount + boxCount) * (hasNestedMedia ? 10u : 1u) + 3u;
    if (hasTriangles)
        ok = traverse(best, ray, quadCount + sphereCount + boxCount, active_ && triangleCount > 0u, tests) && ok;
    return best;
}

// `inside` of a ray whose first hit is `hit`: a ray from a surface in a mesh's boundary may start beyond it.
uint noticeEntry(Ray ray, Hit hit) {
    uint index = hit.primitive - (quadCount + sphereCount + boxCount);
    bool isTriangle = hit.primitive != kNone && index < triangleCount;
    int texel = int(kTriangleTexels * (isTriangle ? index : 0u));
    vec4 a = texelFetch(triangleTexels, texel);
    vec3 b = texelFetch(triangleTexels, texel + 1).xyz, c = texelFetch(triangleTexels, texel + 2).xyz;
    uint shape = isTriangle ? floatBitsToUint(a.w) : 0u;
    bool isNull = isTriangle && (shapeAt(shape).flags & kShapeNull) != 0u;
    bool starts = ray.last != kNone && ray.tMin == 0.0 && !surrounds(shape, ray.inside);
    return isNull && starts && dot(ray.direction, cross(b - a.xyz, c - a.xyz)) > 0.0 ? shape : ray.inside;
}

// `inside` after the ray crosses a null boundary at `hit`.
uint crossBoundary(Ray ray, Hit hit, uint shapeIndex, uint exterior, vec3 geometricNormal) {
    uint first = quadCount;
    bool convex = !(hasQuads || hasTriangles) ||
                  (hit.primitive >= first && hit.primitive < first + sphereCount + boxCount);
    bool enters = convex ? !hit.exits : dot(ray.direction, geometricNormal) < 0.0;
    return enters ? shapeIndex : (ray.inside == shapeIndex ? exterior : ray.inside);
}

#endif
