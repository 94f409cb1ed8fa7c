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
    Face face;
    vec2 weights;
};

// The plane of a face, from the corner with the widest angle: the other two give a sliver's normal few digits.
struct Plane {
    vec3 at;
    vec3 normal;   // unit
    float spread;  // 1 / sine of that angle: by as much are the normal's roundings larger
};

Plane planeOf(Face f) {
    vec3 ab = f.b - f.a, bc = f.c - f.b, ca = f.a - f.c;
    float a = dot(bc, bc), b = dot(ca, ca), c = dot(ab, ab);  // squares of the edges opposite to the corners
    bool isA = a >= b && a >= c, isB = b >= c;
    vec3 u = isA ? ab : isB ? bc : ca, v = isA ? -ca : isB ? -ab : -bc;
    vec3 doubled = cross(u, v);
    float size = length(doubled);
    return Plane(isA ? f.a : isB ? f.b : f.c, doubled / size, length(u) * length(v) / size);
}

const float kFlatRoundings = 4.76837158e-7;  // 8 of 2^-24

// A point's distance from the plane of a face, and a bound of its error: both 0 for a corner of the face.
vec2 planeDistance(Plane plane, Face face, vec3 point) {
    vec3 x = point - plane.at;
    bool isCorner = point == face.a || point == face.b || point == face.c;
    float error = kFlatRoundings * (plane.spread * length(x) + length(point));
    return isCorner ? vec2(0.0) : vec2(dot(plane.normal, x), error);
}

// Of a ray's start, from the corner of the face that it is nearest to: what is close subtracts without rounding. Of quads
// one corner alone is exact.
vec2 startDistance(Plane plane, Face face, bool isQuad, vec3 origin) {
    vec3 a = origin - face.a, b = origin - face.b, c = origin - face.c;
    vec3 nearer = dot(b, b) < dot(a, a) ? b : a;
    vec3 x = isQuad ? a : dot(c, c) < dot(nearer, nearer) ? c : nearer;
    return vec2(dot(plane.normal, x), kFlatRoundings * plane.spread * length(x));
}

// Whether the ray goes on past the opaque flat primitive it has met.
bool leavesAside(Ray ray, Hit hit, Surface met, Start start) {
    bool isQuad = hasQuads && hit.primitive < quadCount;
    Plane left = planeOf(start.face), other = planeOf(met.face);
    float side = dot(left.normal, ray.direction) < 0.0 ? -1.0 : 1.0, heading = dot(other.normal, ray.direction);
    vec2 a = planeDistance(left, start.face, met.face.a), b = planeDistance(left, start.face, met.face.b),
         c = planeDistance(left, start.face, met.face.c);
    bool rises = side * a.x > a.y || side * b.x > b.y || side * c.x > c.y;
    if (isQuad) {
        vec2 d = planeDistance(left, start.face, met.face.b + (met.face.c - met.face.a));
        rises = rises || side * d.x > d.y;
    }
    a = planeDistance(other, met.face, start.face.a);
    b = planeDistance(other, met.face, start.face.b);
    c = planeDistance(other, met.face, start.face.c);
    vec3 weights = vec3(1.0 - start.weights.x - start.weights.y, start.weights);
    float ideal = dot(weights, vec3(a.x, b.x, c.x)), middle = a.x + b.x + c.x;
    bool decided = abs(ideal) > dot(abs(weights), vec3(a.y, b.y, c.y));
    bool straddles = (a.x > a.y || b.x > b.y || c.x > c.y) && (-a.x > a.y || -b.x > b.y || -c.x > c.y);
    vec2 height = startDistance(other, met.face, isQuad, ray.origin);
    bool certain = abs(height.x) > height.y, ahead = height.x * heading < 0.0;
    bool into = straddles ? hit.t > 0.0 : abs(middle) > a.y + b.y + c.y && middle * heading < 0.0;
    if (certain) into = ahead;
    if (decided && !straddles) into = ideal * heading < 0.0;
    if (!rises) into = decided && ideal * heading > 0.0 && certain && ahead;
    return hit.near && !into;
}

#endif
