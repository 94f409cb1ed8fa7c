// The surface at a hit.
#ifndef GEOMETRY_SURFACE_GLSL
#define GEOMETRY_SURFACE_GLSL

#include "core/math.glsl"
#include "core/scene.glsl"
#include "core/unroll.glsl"
#include "geometry/ray.glsl"

const float kPositionError = 4.2e-7;  // 7 roundings of 2^-24

const bool hasSurfaceUvs = hasTextures || hasTexturedLights;

vec2 triangleUv(uint index, vec2 uv) {
    int texel = int(3u * index);
    return texelFetch(triangleUvTexels, texel).xy * (1.0 - uv.x - uv.y) +
           texelFetch(triangleUvTexels, texel + 1).xy * uv.x + texelFetch(triangleUvTexels, texel + 2).xy * uv.y;
}

// Triangle `index`: position, normals and error bound (PBR4 6.8.5).
Surface triangleSurface(uint index, vec2 uv) {
    int texel = int(kTriangleTexels * index);
    vec4 a = texelFetch(triangleTexels, texel);
    vec3 b = texelFetch(triangleTexels, texel + 1).xyz, c = texelFetch(triangleTexels, texel + 2).xyz;
    vec3 u = b - a.xyz, v = c - a.xyz, doubled = cross(u, v);
    float first = 1.0 - uv.x - uv.y, least = min(first, min(uv.x, uv.y));
    float longest = sqrt(max(dot(u, u), max(dot(v, v), dot(u - v, u - v)))), height = length(doubled) / longest;
    vec3 spread = abs(first * a.xyz) + abs(uv.x * b) + abs(uv.y * c);
    float lateral = kPositionError * (maxComponent(spread) + longest);
    if (least * height < 4.0 * lateral) uv += min(0.5, 12.0 * lateral / height) * (1.0 / 3.0 - uv);
    first = 1.0 - uv.x - uv.y;
    vec3 normal = normalize(doubled);
    vec3 shading = normal;
    if (hasVertexNormals) {
        vec3 sum = texelFetch(vertexNormalTexels, texel).xyz * first +
                   texelFetch(vertexNormalTexels, texel + 1).xyz * uv.x +
                   texelFetch(vertexNormalTexels, texel + 2).xyz * uv.y;
        float square = dot(sum, sum);
        shading = square > 0.0 ? sum * inversesqrt(square) : normal;  // all zero: a flat triangle (H53)
    }
    vec3 error = kPositionError * (abs(first * a.xyz) + abs(uv.x * b) + abs(uv.y * c));
    float offset = dot(abs(normal), error);
    return Surface(a.xyz * first + b * uv.x + c * uv.y, normal, shading, offset, floatBitsToUint(a.w),
                   hasSurfaceUvs ? triangleUv(index, uv) : vec2(0.0), 2.0 * offset, Face(a.xyz, b, c), uv);
}

// Box: the face whose local coordinate is largest; its gradient is the world normal.
vec3 boxNormal(Box box, vec3 position) {
    vec3 p = box.localFromWorld * vec4(position, 1.0);
    vec3 a = abs(p);
    vec3 face = a.x >= a.y && a.x >= a.z ? vec3(sign(p.x), 0.0, 0.0)
              : a.y >= a.z ? vec3(0.0, sign(p.y), 0.0) : vec3(0.0, 0.0, sign(p.z));
    return normalize(face * mat3(box.localFromWorld));
}

vec2 sphereUv(Sphere s, vec3 n) {
    vec3 local = vec3(dot(n, s.axisX), s.handedness * dot(n, cross(s.axisZ, s.axisX)), dot(n, s.axisZ));
    float turn = angleOf(local.y, local.x) * (0.5 * kInvPi);
    return vec2(turn < 0.0 ? turn + 1.0 : turn, angleOf(length(local.xy), local.z) * kInvPi);
}

// On the face that boxNormal picks.
vec2 boxUv(Box box, vec3 position) {
    vec3 p = box.localFromWorld * vec4(position, 1.0);
    vec3 a = abs(p);
    vec2 onX = vec2(p.y, p.x > 0.0 ? -p.z : p.z);
    vec2 onY = p.y > 0.0 ? vec2(-p.x, -p.z) : vec2(p.z, p.x);
    vec2 onZ = vec2(p.z > 0.0 ? p.y : -p.y, p.x);
    return 0.5 + 0.5 * (a.x >= a.y && a.x >= a.z ? onX : a.y >= a.z ? onY : onZ);
}

// Shader only: within surfaceAt in the reference.
vec2 quadUv(Quad quad, vec3 position) {
    vec3 p = position - quad.corner;
    return vec2(dot(quad.uFromWorld, p), dot(quad.vFromWorld, p));
}

// Shader only: within surfaceAt in the reference.
Surface quadSurface(Quad quad, vec3 position) {
    vec2 computed = quadUv(quad, position), uv = clamp(computed, 0.0, 1.0), rest = min(uv, 1.0 - uv);
    vec2 lengths = vec2(length(quad.edgeU), length(quad.edgeV)), size = kPositionError * (maxComponent(abs(position)) + lengths);
    vec2 move = mix(vec2(0.0), min(vec2(0.5), 4.0 * size / lengths), lessThan(rest * lengths, size)) * (0.5 - uv);
    vec2 shift = uv - computed + move;
    position += shift.x * quad.edgeU + shift.y * quad.edgeV;
    vec3 p = position - quad.corner;
    float slack = abs(dot(quad.normal, p)) + 2.98023224e-7 * dot(abs(quad.normal), abs(p));  // 5 roundings
    Face face = Face(quad.corner, quad.corner + quad.edgeU, quad.corner + quad.edgeV);
    return Surface(position, quad.normal, quad.normal, 0.0, quad.shape, uv, slack, face, uv + move);
}

// Shader only: the reference's members have defaults.
Surface roundSurface(vec3 position, vec3 normal, uint shape, vec2 uv) {
    return Surface(position, normal, normal, 0.0, shape, uv, -1.0, Face(vec3(0.0), vec3(0.0), vec3(0.0)), vec2(0.0));
}

Surface sphereSurface(Sphere s, vec3 position) {
    vec3 n = normalize(position - s.center);
    vec3 front = (s.flags & kShapeFlipNormal) != 0u ? -n : n;
    vec2 uv = hasSurfaceUvs ? sphereUv(s, n) : vec2(0.0);
    return roundSurface(s.center + n * s.radius, front, s.shape, uv);
}

Surface boxSurface(Box b, vec3 position) {
    vec3 n = boxNormal(b, position);
    vec3 front = (b.flags & kShapeFlipNormal) != 0u ? -n : n;
    vec2 uv = hasSurfaceUvs ? boxUv(b, position) : vec2(0.0);
    return roundSurface(position, front, b.shape, uv);
}

// The primitive is picked by comparison: that costs less than a gather.
Surface surfaceAt(Ray ray, Hit hit) {
    vec3 position = ray.origin + ray.direction * hit.t;
    Surface surface = roundSurface(position, vec3(0.0), 0u, vec2(0.0));
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
