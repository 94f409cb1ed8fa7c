// A path in flight, and how a lane keeps it between dispatches.
// Shader only: the reference never suspends a path.
#ifndef INTEGRATOR_PATH_STATE_GLSL
#define INTEGRATOR_PATH_STATE_GLSL

#include "geometry/flat.glsl"
#include "geometry/ray.glsl"
#include "integrator/state_words.glsl"
#include "volume/tracking.glsl"

struct Path {
    Ray ray;
    Hit hit;               // ahead on the ray: the end of the segment
    Segment segment;
    Stream stream;
    uint vertex;           // scatterings so far
    uint sampleIndex;      // within the window
    vec3 beta;             // throughput
    vec3 radiance;
    vec3 pending;          // what the shadow ray brings if nothing is in its way
    float lastPdf;         // of the last scattering's direction, times its samples; infinite from the camera
    vec3 nextDirection;    // of the flight to come, after the shadow ray if there is one
    uvec2 nextExponential; // words of its first exponential
    vec3 vertexPosition;
    uint vertexInside;
    uint vertexLast;
    Start vertexStart;     // as in Surface, for rays that leave it
    vec3 vertexOffset;     // along the geometric normal
    float vertexSlack;
    uint stalledTurns;     // since it last left, or moved along, a ray
};

layout(set = 0, binding = 26, scalar) buffer LayerBlock { LayerPixel layers[]; };
uint firstLayer;  // of the lane's pixel

// Shader only: the reference never suspends a path.
void saveRay(inout uint at, uint stride, Ray ray, Hit hit) {
    storeVector(at, stride, ray.origin);
    storeVector(at, stride, ray.direction);
    storeVector(at, stride, vec3(ray.tMin, ray.tMax, hit.t));
    storeWord(at, stride, ray.last);
    storeWord(at, stride, ray.target);
    storeWord(at, stride, ray.inside);
    storeWord(at, stride, ray.passed);
    storeWord(at, stride, ray.idle);
    storeWord(at, stride, floatBitsToUint(ray.idleT));
    storeWord(at, stride, floatBitsToUint(ray.slack));
    storeWord(at, stride, hit.primitive);
    storeWord(at, stride, floatBitsToUint(hit.uv.x));
    storeWord(at, stride, floatBitsToUint(hit.uv.y));
}

// Shader only: as above. All but the hit's two flags.
void loadRay(inout uint at, uint stride, inout Ray ray, inout Hit hit) {
    ray.origin = loadVector(at, stride);
    ray.direction = loadVector(at, stride);
    vec3 distances = loadVector(at, stride);
    ray.tMin = distances.x;
    ray.tMax = distances.y;
    ray.last = loadWord(at, stride);
    ray.target = loadWord(at, stride);
    ray.inside = loadWord(at, stride);
    ray.passed = loadWord(at, stride);
    ray.idle = loadWord(at, stride);
    ray.idleT = loadFloat(at, stride);
    ray.slack = loadFloat(at, stride);
    hit.t = distances.z;
    hit.primitive = loadWord(at, stride);
    hit.uv.x = loadFloat(at, stride);
    hit.uv.y = loadFloat(at, stride);
}

// Shader only: as above.
void savePath(uint lane, uint stride, Path p) {
    uint at = lane;
    storeWord(at, stride, p.sampleIndex);  // column kPathSampleWord
    saveRay(at, stride, p.ray, p.hit);
    Segment s = p.segment;
    storeVector(at, stride, vec3(s.t, s.residual, s.threshold));
    storeVector(at, stride, s.weight);
    storeVector(at, stride, s.ratio);
    storeWord(at, stride, floatBitsToUint(s.end));
    storeWord(at, stride, s.collisions);
    storeWord(at, stride, uint(s.cell.x) | uint(s.cell.y) << 10u | uint(s.cell.z) << 20u);
    storeWord(at, stride, s.state | (s.shadow ? 4u : 0u) | (p.hit.exits ? 8u : 0u) | (p.hit.near ? 16u : 0u) | s.hero << 5u);
    storeWord(at, stride, p.vertex);
    storeVector(at, stride, p.beta);
    storeVector(at, stride, p.radiance);
    storeVector(at, stride, p.pending);
    storeVector(at, stride, p.nextDirection);
    storeVector(at, stride, p.vertexPosition);
    storeVector(at, stride, p.vertexStart.face.a);
    storeVector(at, stride, p.vertexStart.face.b);
    storeVector(at, stride, p.vertexStart.face.c);
    storeVector(at, stride, vec3(p.vertexStart.weights, p.vertexSlack));
    storeVector(at, stride, p.vertexOffset);
    storeWord(at, stride, floatBitsToUint(p.lastPdf));
    storeWord(at, stride, p.nextExponential.x);
    storeWord(at, stride, p.nextExponential.y);
    storeWord(at, stride, p.vertexInside);
    storeWord(at, stride, p.vertexLast);
    storeWord(at, stride, p.stalledTurns);
}

// Shader only: as above.
void loadPath(uint lane, uint stride, inout Path p) {
    uint at = lane;
    p.sampleIndex = loadWord(at, stride);
    loadRay(at, stride, p.ray, p.hit);
    vec3 progress = loadVector(at, stride);
    vec3 weight = loadVector(at, stride), ratio = loadVector(at, stride);
    float end = loadFloat(at, stride);
    uint collisions = loadWord(at, stride), cell = loadWord(at, stride), bits = loadWord(at, stride);
    p.hit.exits = (bits & 8u) != 0u;
    p.hit.near = (bits & 16u) != 0u;
    p.segment = Segment(progress.x, end, progress.y, collisions,
                        ivec3(uvec3(cell, cell >> 10u, cell >> 20u) & 1023u), bits & 3u, (bits & 4u) != 0u,
                        bits >> 5u, progress.z, weight, ratio);
    p.vertex = loadWord(at, stride);
    p.beta = loadVector(at, stride);
    p.radiance = loadVector(at, stride);
    p.pending = loadVector(at, stride);
    p.nextDirection = loadVector(at, stride);
    p.vertexPosition = loadVector(at, stride);
    p.vertexStart.face.a = loadVector(at, stride);
    p.vertexStart.face.b = loadVector(at, stride);
    p.vertexStart.face.c = loadVector(at, stride);
    vec3 start = loadVector(at, stride);
    p.vertexStart.weights = start.xy;
    p.vertexSlack = start.z;
    p.vertexOffset = loadVector(at, stride);
    p.lastPdf = loadFloat(at, stride);
    p.nextExponential.x = loadWord(at, stride);
    p.nextExponential.y = loadWord(at, stride);
    p.vertexInside = loadWord(at, stride);
    p.vertexLast = loadWord(at, stride);
    p.stalledTurns = loadWord(at, stride);
}

#endif
