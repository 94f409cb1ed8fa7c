// The scene's closest hit, the surface there, and the crossing of medium boundaries.
#ifndef GEOMETRY_INTERSECTION_GLSL
#define GEOMETRY_INTERSECTION_GLSL

#include "core/scene.glsl"
#include "core/math.glsl"
#include "geometry/bvh.glsl"
#include "geometry/primitives.glsl"
#include "geometry/ray.glsl"

struct Surface {
    vec3 position;
    vec3 geometricNormal;  // unit, front side
    vec3 shadingNormal;    // unit
    vec3 offset;           // along the geometric normal: bound of the position's rounding error
    uint shape;
};

// The rule for convex primitives (README, "Rays"). `flags` are the shape's.
void hitConvex(inout Hit best, Ray ray, vec2 interval, uint primitive, uint shape, uint flags) {
    bool isNull = (flags & kShapeNull) != 0u;
    bool around = isNull && shape == ray.inside;
    bool ahead = interval.x + interval.y > 2.0 * ray.tMin && interval.y >= interval.x;
    float entry = isNull ? max(interval.x, ray.tMin)
                         : (interval.x >= ray.tMin && primitive != ray.last ? interval.x : interval.y);
    bool enters = ahead && primitive != ray.target && (!isNull || (primitive != ray.last && interval.y > ray.tMin));
    float t = around ? max(interval.y, ray.tMin) : entry;
    if (around || enters) keepNearer(best, Hit(t, primitive, vec2(0.0), around));
}

// First hit in [tMin, tMax) for lanes that are `active_`. Sets ok to false when a traversal was cut short.
Hit closestHit(Ray ray, bool active_, inout uint tests, inout bool ok) {
    Hit best = Hit(ray.tMax, kNone, vec2(0.0), false);
    if (hasQuads) {
        for (uint i = 0u; i < quadCount; ++i) {
            float t = intersectQuad(scene.quads[i], ray.origin, ray.direction);
            if (t > ray.tMin && i != ray.last && i != ray.target)
                keepNearer(best, Hit(t, i, vec2(0.0), false));
        }
        tests += quadCount + 1u;
    }
    if (hasSpheres) {
        for (uint i = 0u; i < sphereCount; ++i) {
            Sphere s = scene.spheres[i];
            vec2 interval = sphereInterval(s.center, s.radius, ray.origin, ray.direction);
            hitConvex(best, ray, interval, quadCount + i, s.shape, s.flags);
        }
        tests += sphereCount + 1u;
    }
    if (hasBoxes) {
        for (uint i = 0u; i < boxCount; ++i) {
            Box b = scene.boxes[i];
            vec2 interval = boxInterval(b.localFromWorld, ray.origin, ray.direction);
            hitConvex(best, ray, interval, quadCount + sphereCount + i, b.shape, b.flags);
        }
        tests += boxCount + 1u;
    }
    if (hasTriangles)
        ok = traverse(best, ray, quadCount + sphereCount + boxCount, active_ && scene.triangleCount > 0u, tests) && ok;
    return best;
}

// Triangle `index`: position, normals and error bound (PBR4 6.8.5).
Surface triangleSurface(uint index, vec2 uv) {
    int texel = int(kTriangleTexels * index);
    vec4 a = texelFetch(triangleTexels, texel);
    vec3 b = texelFetch(triangleTexels, texel + 1).xyz, c = texelFetch(triangleTexels, texel + 2).xyz;
    float first = 1.0 - uv.x - uv.y;
    vec3 normal = normalize(cross(b - a.xyz, c - a.xyz));
    vec3 shading = normal;
    if (hasVertexNormals) {
        vec3 sum = texelFetch(vertexNormalTexels, texel).xyz * first +
                   texelFetch(vertexNormalTexels, texel + 1).xyz * uv.x +
                   texelFetch(vertexNormalTexels, texel + 2).xyz * uv.y;
        float square = dot(sum, sum);
        shading = square > 0.0 ? sum * inversesqrt(square) : normal;  // all zero: a flat triangle (H53)
    }
    vec3 error = 4.2e-7 * (abs(first * a.xyz) + abs(uv.x * b) + abs(uv.y * c));  // 7 roundings of 2^-24
    return Surface(a.xyz * first + b * uv.x + c * uv.y, normal, shading,
                   normal * (dot(abs(normal), error)), floatBitsToUint(a.w));
}

// Box: the face whose local coordinate is largest; its gradient is the world normal.
vec3 boxNormal(Box box, vec3 position) {
    vec3 p = box.localFromWorld * vec4(position, 1.0);
    vec3 a = abs(p);
    vec3 face = a.x >= a.y && a.x >= a.z ? vec3(sign(p.x), 0.0, 0.0)
              : a.y >= a.z ? vec3(0.0, sign(p.y), 0.0) : vec3(0.0, 0.0, sign(p.z));
    return normalize(face * mat3(box.localFromWorld));
}

Surface sphereSurface(Sphere s, vec3 position) {
    vec3 n = normalize(position - s.center);
    vec3 front = (s.flags & kShapeFlipNormal) != 0u ? -n : n;
    return Surface(s.center + n * s.radius, front, front, vec3(0.0), s.shape);
}

Surface boxSurface(Box b, vec3 position) {
    vec3 n = boxNormal(b, position);
    vec3 front = (b.flags & kShapeFlipNormal) != 0u ? -n : n;
    return Surface(position, front, front, vec3(0.0), b.shape);
}

// The primitives are picked by comparison: loads at constant offsets cost less than gathers.
Surface surfaceAt(Ray ray, Hit hit) {
    vec3 position = ray.origin + ray.direction * hit.t;
    Surface surface = Surface(position, vec3(0.0), vec3(0.0), vec3(0.0), 0u);
    if (hasQuads)
        for (uint i = 0u; i < quadCount; ++i)
            if (hit.primitive == i)
                surface = Surface(position, scene.quads[i].normal, scene.quads[i].normal, vec3(0.0), scene.quads[i].shape);
    if (hasSpheres)
        for (uint i = 0u; i < sphereCount; ++i)
            if (hit.primitive == quadCount + i) surface = sphereSurface(scene.spheres[i], position);
    if (hasBoxes)
        for (uint i = 0u; i < boxCount; ++i)
            if (hit.primitive == quadCount + sphereCount + i) surface = boxSurface(scene.boxes[i], position);
    if (hasTriangles) {
        uint index = hit.primitive - (quadCount + sphereCount + boxCount);
        if (index < scene.triangleCount) surface = triangleSurface(index, hit.uv);
    }
    return surface;
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
