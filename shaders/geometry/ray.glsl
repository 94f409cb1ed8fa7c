// Rays and hits.
#ifndef GEOMETRY_RAY_GLSL
#define GEOMETRY_RAY_GLSL

// origin and direction stay while the ray crosses null boundaries; tMin moves (README, "Rays").
struct Ray {
    vec3 origin;
    float tMin;
    vec3 direction;  // unit
    float tMax;
    uint last;       // primitive the ray starts on, or kNone
    uint target;     // primitive to ignore (the light a shadow ray goes to), or kNone
    uint inside;     // shape whose interior surrounds the ray at tMin, or kNone
};

struct Hit {
    float t;
    uint primitive;  // kNone: nothing before tMax
    vec2 uv;         // triangles: barycentrics of the second and third vertex
    bool exits;      // leaves the convex null shape the ray is inside
};

// Keeps the nearer of two hits; at equal t the exit of a null boundary wins, then the lowest primitive.
void keepNearer(inout Hit best, Hit candidate) {
    bool nearer = candidate.t < best.t;
    bool tie = candidate.t == best.t && !best.exits && (candidate.exits || candidate.primitive < best.primitive);
    if (nearer || tie) best = candidate;
}

#endif
