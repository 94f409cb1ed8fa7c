// The surface at a hit.
#ifndef GEOMETRY_SURFACE_GLSL
#define GEOMETRY_SURFACE_GLSL

#include "core/scene.glsl"
#include "core/unroll.glsl"
#include "geometry/ray.glsl"

struct Surface {
    vec3 position;
    vec3 geometricNormal;  // unit, front side
    vec3 shadingNormal;    // unit
    vec3 offset;           // along the geometric normal: bound of the position's rounding error
    uint shape;
};

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

// Shader only: within surfaceAt in the reference.
Surface quadSurface(Quad quad, vec3 position) {
    return Surface(position, quad.normal, quad.normal, vec3(0.0), quad.shape);
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

// The primitive is picked by comparison: that costs less than a gather.
Surface surfaceAt(Ray ray, Hit hit) {
    vec3 position = ray.origin + ray.direction * hit.t;
    Surface surface = Surface(position, vec3(0.0), vec3(0.0), vec3(0.0), 0u);
#define PICK_QUAD(i) \
    if (hit.primitive == i) surface = quadSurface(nearQuads[i], position);
#define PICK_FAR_QUAD(i) \
    if (hit.primitive == i) surface = quadSurface(scene.quads[i], position);
#define PICK_SPHERE(i) \
    if (hit.primitive == quadCount + i) surface = sphereSurface(nearSpheres[i], position);
#define PICK_FAR_SPHERE(i) \
    if (hit.primitive == quadCount + i) surface = sphereSurface(scene.spheres[i], position);
#define PICK_BOX(i) \
    if (hit.primitive == quadCount + sphereCount + i) surface = boxSurface(nearBoxes[i], position);
#define PICK_FAR_BOX(i) \
    if (hit.primitive == quadCount + sphereCount + i) surface = boxSurface(scene.boxes[i], position);
    if (hasQuads) { FOR_EACH(quadCount, PICK_QUAD, PICK_FAR_QUAD) }
    if (hasSpheres) { FOR_EACH(sphereCount, PICK_SPHERE, PICK_FAR_SPHERE) }
    if (hasBoxes) { FOR_EACH(boxCount, PICK_BOX, PICK_FAR_BOX) }
    if (hasTriangles) {
        uint index = hit.primitive - (quadCount + sphereCount + boxCount);
        if (index < triangleCount) surface = triangleSurface(index, hit.uv);
    }
    return surface;
}

#endif
