// Closest hit among the triangles: two children per node, nearer one first, a short private stack.
#ifndef GEOMETRY_BVH_GLSL
#define GEOMETRY_BVH_GLSL

#include "core/math.glsl"
#include "core/scene.glsl"
#include "geometry/ray.glsl"
#include "geometry/triangle.glsl"

// Shader only: 1 / d with the largest finite number for 1 / 0, so that a plane through the origin gives 0 and not
// 0 * infinity, which would prune both of the boxes that share the face a ray runs in (H39).
vec3 finiteInverse(vec3 d) { return mix(1.0 / d, vec3(3.4028234e38), equal(d, vec3(0.0))); }

// Entry distance of a box widened by `slack`, or kInfinity; the far side is widened by three roundings more so that no
// ray slips between touching boxes (Ize 2013, "Robust BVH Ray Traversal"). `low` and `high`: the origin less and plus slack.
float boxEntry(vec3 minimum, vec3 maximum, vec3 low, vec3 high, vec3 inverse, float tMin, float tMax) {
    vec3 a = (minimum - high) * inverse;
    vec3 b = (maximum - low) * inverse;
    vec3 entry = min(a, b), exit = max(a, b);
    float t0 = max(max(entry.x, entry.y), max(entry.z, tMin));
    float t1 = min(min(exit.x, exit.y), min(exit.z, tMax)) * 1.0000004;
    return t0 <= t1 ? t0 : kInfinity;
}

// Distances to triangles round more than those to their bounds: by the width of a triangle, not by the distance.
// Without a margin a ray that has left a medium misses the floor that the medium stands on.
const float kDistanceMargin = 0.001;

void hitLeaf(inout Hit best, Ray ray, RayShear shear, int leaf, uint firstPrimitive) {
    uint first = uint(leaf) >> 3u, count = uint(leaf) & 7u;
    for (uint i = 0u; i < count; ++i) {
        uint triangle = first + i;
        int texel = int(kTriangleTexels * triangle);
        vec4 hit = intersectTriangle(ray.origin, shear, texelFetch(triangleTexels, texel).xyz,
                                     texelFetch(triangleTexels, texel + 1).xyz,
                                     texelFetch(triangleTexels, texel + 2).xyz, max(ray.slack, 0.0));
        hitFlat(best, ray, hit.x, hit.w, firstPrimitive + triangle, hit.yz);
    }
}

// A step costs up to kMaxLeafTriangles + 2 loop-back tests of the 65535 a subgroup has (README, "Loop budget").
const uint kMaxTraversalSteps = 8192u;

// Improves `best` by the nearest triangle. Adds the loop-back tests spent to `tests`; false when the
// limit cut the traversal short.
bool traverse(inout Hit best, Ray ray, uint firstPrimitive, bool active_, inout uint tests) {
    RayShear shear = rayShear(ray.direction);
    vec3 inverse = finiteInverse(ray.direction);
    int stack[kBvhStackSize];
    int depth = 0;
    int node = active_ ? 0 : kBvhEnd;
    uint steps = 0u;
    float tMin = ray.tMin * (1.0 - kDistanceMargin), slack = max(ray.slack, 0.0);
    vec3 low = ray.origin - slack, high = ray.origin + slack;
    while (node != kBvhEnd && steps < kMaxTraversalSteps) {
        // Down to a leaf in a loop of its own: lanes do not wait for triangles at every node.
        uint down = 0u;
        while (node >= 0 && node != kBvhEnd && steps + down < kMaxTraversalSteps) {
            ++down;
            int texel = int(kBvhNodeTexels) * node;
            vec4 min0 = texelFetch(bvhTexels, texel), max0 = texelFetch(bvhTexels, texel + 1);
            vec4 min1 = texelFetch(bvhTexels, texel + 2), max1 = texelFetch(bvhTexels, texel + 3);
            float t0 = boxEntry(min0.xyz, max0.xyz, low, high, inverse, tMin, best.t * (1.0 + kDistanceMargin));
            float t1 = boxEntry(min1.xyz, max1.xyz, low, high, inverse, tMin, best.t * (1.0 + kDistanceMargin));
            int child0 = floatBitsToInt(min0.w), child1 = floatBitsToInt(min1.w);
            bool swap = t1 < t0;
            int near = swap ? child1 : child0, far = swap ? child0 : child1;
            if (max(t0, t1) < kInfinity) stack[depth++] = far;
            node = min(t0, t1) < kInfinity ? near : (depth > 0 ? stack[--depth] : kBvhEnd);
        }
        steps += subgroupMax(down) + 1u;  // of all lanes still here: those that stay longest count what the subgroup spends
        if (node < 0) {
            hitLeaf(best, ray, shear, ~node, firstPrimitive);
            node = depth > 0 ? stack[--depth] : kBvhEnd;
        }
    }
    tests += subgroupMax(steps) * (kMaxLeafTriangles + 2u) + 1u;
    return node == kBvhEnd;
}

#endif
