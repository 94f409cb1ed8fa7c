// Rays, hits, and what is there.
#ifndef GEOMETRY_RAY_GLSL
#define GEOMETRY_RAY_GLSL

// origin and direction stay while the ray crosses null boundaries; the rest moves (README, "Rays").
struct Ray {
    vec3 origin;
    float tMin;
    vec3 direction;  // unit
    float tMax;
    uint last;       // primitive the ray starts on, or kNone
    uint target;     // primitive to ignore (the light a shadow ray goes to), or kNone
    uint inside;     // shape whose interior surrounds the ray at tMin, or kNone
    uint passed;     // 1 + the last flat primitive that the ray has dealt with at tMin; 0: none yet
    uint idle;       // the last crossing that changed nothing: 2 (shape + 1), plus 1 if it was an entry; 0: none
    float idleT;     // where that was
    float slack;     // how far the start may lie off the flat surface that the ray leaves; negative where it leaves none
};

struct Hit {
    float t;
    uint primitive;  // kNone: nothing before tMax
    vec2 uv;         // triangles: barycentrics of the second and third vertex
    bool exits;      // leaves the convex null shape the ray is inside
    bool near;       // flat primitive that the ray's start lies in within rounding: t says nothing about which side
};

// Corners of a triangle, or three of a quad's, whose fourth is b + c - a.
struct Face {
    vec3 a, b, c;
};

struct Surface {
    vec3 position;
    vec3 geometricNormal;  // unit, front side
    vec3 shadingNormal;    // unit
    float offset;          // by which rays leave it along the geometric normal: bound of the position's rounding error
    uint shape;
    vec2 uv;               // for textures; 0 where the scene has none
    float slack;           // quads and triangles: how far a ray's start may lie off it; negative: others
    Face face;
    vec2 weights;          // position: face.a + weights.x (face.b - face.a) + weights.y (face.c - face.a)
};

// A ray from the camera, from a surface or from a medium that has not met anything yet.
// Shader only: the reference's members have defaults.
Ray newRay(vec3 origin, vec3 direction, float tMax, uint last, uint target, uint inside, float slack) {
    return Ray(origin, 0.0, direction, tMax, last, target, inside, 0u, 0u, 0.0, slack);
}

// Whether a flat primitive met at t is still to come: those at one t come in the order of their ids, each once.
bool isAhead(Ray ray, float t, uint primitive) {
    return t > ray.tMin || (t == ray.tMin && primitive >= ray.passed);
}

// Keeps the nearer of two hits; at equal t the exit of a null boundary wins, then the lowest primitive.
void keepNearer(inout Hit best, Hit candidate) {
    bool nearer = candidate.t < best.t;
    bool tie = candidate.t == best.t && !best.exits && (candidate.exits || candidate.primitive < best.primitive);
    if (nearer || tie) best = candidate;
}

// A flat primitive met at t, known to `error`.
void hitFlat(inout Hit best, Ray ray, float t, float error, uint primitive, vec2 uv) {
    bool near = ray.slack >= 0.0 && abs(t) <= error;
    float at = near ? max(t, 0.0) : t;
    if (isAhead(ray, at, primitive) && at < ray.tMax && primitive != ray.last && primitive != ray.target)
        keepNearer(best, Hit(at, primitive, uv, false, near));
}

#endif
