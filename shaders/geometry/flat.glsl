// Rays that leave a flat primitive, and the flat primitives that their start lies in within rounding: those that share an
// edge or a corner with it, lie in it or stand on it (README, "The start of a ray").
#ifndef GEOMETRY_FLAT_GLSL
#define GEOMETRY_FLAT_GLSL

#include "core/scene.glsl"
#include "geometry/ray.glsl"
#include "geometry/surface.glsl"

bool isFlatPrimitive(uint primitive) {
    bool isQuad = hasQuads && primitive < quadCount;
    bool isTriangle = hasTriangles && primitive != kNone && primitive >= quadCount + sphereCount + boxCount;
    return isQuad || isTriangle;
}

// What a ray needs to know of the flat primitive that it left: members of Surface.
struct Start {
    vec3 normal;
    vec3 edge;
    vec3 inward;
};

// Whether the ray goes on past the opaque flat primitive it has met.
bool leavesAside(Ray ray, Hit hit, Surface met, Start start) {
    bool isNext = start.edge != vec3(0.0);
    // Normal to the edge to the last digit: of a sliver, that of its corners is not.
    vec3 up = isNext ? normalize(cross(start.edge, start.inward)) : start.normal;
    up = dot(start.normal, ray.direction) * dot(start.normal, up) < 0.0 ? -up : up;
    vec3 a = met.corner - ray.origin, b = a + met.edgeU, c = a + met.edgeV;
    float reach = max(dot(up, a), max(dot(up, b), dot(up, c)));
    if (hasQuads && hit.primitive < quadCount) reach = max(reach, dot(up, b + met.edgeV));
    vec3 size = max(abs(a), max(abs(b), abs(c)));
    bool rises = reach > 5.96046448e-7 * dot(abs(up), size) + ray.slack;
    vec3 normal = met.geometricNormal;
    float heading = dot(normal, ray.direction), level = dot(normal, up), along = dot(normal, start.edge);
    bool shares = abs(along) < 0.0078125;
    float side = dot(normal, start.inward) - (shares ? dot(start.edge, start.inward) * along : 0.0);
    bool through = abs(level) > 0.99 ? heading * level < 0.0 : side > 0.0 ? heading <= 0.0 : heading >= 0.0;
    return hit.near && !(rises && (isNext ? through : hit.t > 0.0));
}

#endif
