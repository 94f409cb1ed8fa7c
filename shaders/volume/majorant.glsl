// Walks a ray through the majorant cells of a medium.
//
// Distances are recomputed from integer planes at every step: nothing drifts (H26). Border
// cells extend outwards, as the clamped field does.
#ifndef VOLUME_MAJORANT_GLSL
#define VOLUME_MAJORANT_GLSL

#include "core/scene.glsl"
#include "core/math.glsl"

// A ray in voxel units; t stays the ray's own.
struct GridRay {
    vec3 origin;
    vec3 direction;
    vec3 inverse;
    vec3 forward;  // 1 on axes with a positive direction
    ivec3 border;  // last cell on the way; the start cell's own where the ray does not move
    ivec3 stride;  // +-1
    float cellSize;  // voxels
};

GridRay gridRay(Medium medium, vec3 origin, vec3 direction, ivec3 cell) {
    vec3 d = mat3(medium.gridFromWorld) * direction;
    ivec3 last = ivec3(medium.cells) - 1;
    ivec3 border = mix(mix(ivec3(0), last, greaterThan(d, vec3(0.0))), cell, equal(d, vec3(0.0)));
    vec3 forward = mix(vec3(0.0), vec3(1.0), greaterThan(d, vec3(0.0)));
    return GridRay(medium.gridFromWorld * vec4(origin, 1.0), d, 1.0 / d, forward, border, 2 * ivec3(forward) - 1,
                   float(kVoxelsPerCell << medium.cellLevel));
}

// Where the ray is inside the grid's box: a grid medium ends there, whatever its boundary encloses.
vec2 gridInterval(Medium medium, vec3 origin, vec3 direction) {
    vec3 o = medium.gridFromWorld * vec4(origin, 1.0);
    vec3 d = mat3(medium.gridFromWorld) * direction;
    vec3 inverse = 1.0 / d, a = -o * inverse, b = (vec3(medium.resolution) - o) * inverse;
    bvec3 still = equal(d, vec3(0.0));
    vec3 entry = mix(min(a, b), vec3(-kInfinity), still), exit = mix(max(a, b), vec3(kInfinity), still);
    vec3 beyond = max(-o, o - vec3(medium.resolution));
    bool misses = any(greaterThan(mix(vec3(-1.0), beyond, still), vec3(0.0)));
    return misses ? vec2(1.0, -1.0) : vec2(max(entry.x, max(entry.y, entry.z)), min(exit.x, min(exit.y, exit.z)));
}

// Cell of the point at distance t.
ivec3 startCell(Medium medium, vec3 origin, vec3 direction, float t) {
    vec3 p = medium.gridFromWorld * vec4(origin, 1.0) + t * (mat3(medium.gridFromWorld) * direction);
    vec3 cell = clamp(floor(p * (1.0 / float(kVoxelsPerCell << medium.cellLevel))), vec3(0.0), vec3(medium.cells - 1u));
    return ivec3(cell);
}

// Distance at which the ray leaves `cell` along each axis; infinite where no next cell is.
vec3 planeDistances(GridRay ray, ivec3 cell) {
    vec3 t = ((vec3(cell) + ray.forward) * ray.cellSize - ray.origin) * ray.inverse;
    return mix(t, vec3(kInfinity), equal(cell, ray.border));
}

// The neighbour across the nearest plane: x before y before z at ties.
ivec3 nextCell(GridRay ray, ivec3 cell, vec3 planes) {
    bool x = planes.x <= planes.y && planes.x <= planes.z;
    bool y = !x && planes.y <= planes.z;
    return cell + ivec3(x ? ray.stride.x : 0, y ? ray.stride.y : 0, x || y ? 0 : ray.stride.z);
}

float majorantAt(Medium medium, ivec3 cell) {
    uint index = (uint(cell.z) * medium.cells.y + uint(cell.y)) * medium.cells.x + uint(cell.x);
    return texelFetch(majorantTexels, int(medium.cellOffset + index)).x;
}

#endif
