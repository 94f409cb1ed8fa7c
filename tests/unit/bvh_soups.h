#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "compile/bvh_builder.h"
#include "shared/scene_types.h"

/// Triangles that are hard on a hierarchy, and rays to find them with.
namespace parhelion::soups {

struct Ray {
    glm::dvec3 origin, direction;
};

struct Soup {
    std::string name;
    std::vector<TriangleVertices> triangles;
};

class Random {
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    float next(float low, float high) { return low + (high - low) * float(engine_() >> 8) * 0x1p-24f; }
    glm::vec3 inCube(float half) { return {next(-half, half), next(-half, half), next(-half, half)}; }

private:
    std::mt19937 engine_;
};

inline Soup randomSoup(std::size_t count, float size) {
    Random random(11);
    Soup soup{"random, " + std::to_string(count), {}};
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 at = random.inCube(1.0f);
        soup.triangles.push_back({at, at + random.inCube(size), at + random.inCube(size)});
    }
    return soup;
}

/// Needles that cross the whole scene.
inline Soup slivers() {
    Random random(12);
    Soup soup{"slivers", {}};
    for (int i = 0; i < 500; ++i) {
        const glm::vec3 a = random.inCube(1.0f), b = random.inCube(1.0f);
        soup.triangles.push_back({a, b, b + random.inCube(1e-3f)});
    }
    return soup;
}

/// A flat grid in a plane of constant z: boxes without thickness.
inline Soup coplanarGrid() {
    Soup soup{"coplanar grid", {}};
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x) {
            const glm::vec3 a(float(x) / 12 - 1, float(y) / 12 - 1, 0.25f), dx(1.0f / 12, 0, 0), dy(0, 1.0f / 12, 0);
            soup.triangles.push_back({a, a + dx, a + dx + dy});
            soup.triangles.push_back({a, a + dx + dy, a + dy});
        }
    return soup;
}

/// Many triangles with one centroid: no plane separates them.
inline Soup coincident() {
    Soup soup{"coincident", {}};
    for (int i = 0; i < 700; ++i) {
        const float s = 0.1f + float(i) * 1e-3f;
        soup.triangles.push_back({glm::vec3(-s, -s, 0), glm::vec3(s, -s, 0), glm::vec3(0, s, 0)});
    }
    return soup;
}

/// Each triangle half the size of the one before: bins put one on one side and the rest on the other.
inline Soup geometric() {
    Soup soup{"geometric", {}};
    for (int i = 0; i < 120; ++i) {
        const float s = std::ldexp(1.0f, -i);
        soup.triangles.push_back({glm::vec3(s, 0, 0), glm::vec3(s, s, 0), glm::vec3(s, 0, s)});
    }
    return soup;
}

inline std::vector<Soup> allSoups() {
    Soup single = randomSoup(1, 1.0f), few = randomSoup(3, 1.0f);
    return {single,       few,        randomSoup(2000, 0.1f), randomSoup(300, 2.0f), slivers(), coplanarGrid(),
            coincident(), geometric()};
}

/// From around and within the soup: towards triangles, a quarter of them close to a corner, and along the axes.
inline std::vector<Ray> raysFor(const Soup& soup, int count) {
    Random random(13);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 origin = random.inCube(i % 3 == 0 ? 0.5f : 3.0f);
        const TriangleVertices& t = soup.triangles[std::size_t(i) * 7919 % soup.triangles.size()];
        float u = random.next(0, 1), v = random.next(0, 1);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        if (i % 4 == 1) u *= 1e-4f, v *= 1e-4f;
        const glm::vec3 target = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
        rays.push_back({origin, glm::normalize(glm::dvec3(target) - glm::dvec3(origin))});
        glm::dvec3 axis(0.0);
        axis[i % 3] = i % 2 ? 1.0 : -1.0;
        rays.push_back({target + 2.0f * glm::vec3(-axis), axis});
    }
    return rays;
}

inline constexpr double kMiss = std::numeric_limits<double>::infinity();

/// Moller and Trumbore 1997, in double. Distance, or kMiss.
inline double intersect(const TriangleVertices& t, const Ray& ray) {
    const glm::dvec3 a(t[0]), e1 = glm::dvec3(t[1]) - a, e2 = glm::dvec3(t[2]) - a;
    const glm::dvec3 p = glm::cross(ray.direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0.0) return kMiss;
    const glm::dvec3 s = ray.origin - a, q = glm::cross(s, e1);
    const double u = glm::dot(s, p) / determinant, v = glm::dot(ray.direction, q) / determinant;
    const double distance = glm::dot(e2, q) / determinant;
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 ? distance : kMiss;
}

struct Visit {
    double distance = kMiss;
    std::size_t deepestStack = 0;
    std::size_t boxes = 0, triangles = 0;  ///< tests
};

/// Slab test in float, as a kernel does it, without any widening of its own.
inline bool meetsBox(const glm::vec4* texel, const Ray& ray, double limit) {
    float near = 0.0f, far = float(std::min(limit * (1.0 + 0x1p-22), 1e30));
    for (int axis = 0; axis < 3; ++axis) {
        const float d = float(ray.direction[axis]), inverse = 1.0f / (d == 0.0f ? 1e-18f : d);
        const float shift = -float(ray.origin[axis]) * inverse;
        const float a = texel[0][axis] * inverse + shift, b = texel[1][axis] * inverse + shift;
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    return near <= far;
}

/// Walks the encoded nodes with a stack.
inline Visit closestHit(const Bvh& bvh, const std::vector<TriangleVertices>& triangles, const Ray& ray) {
    Visit visit;
    std::vector<int> stack = {0};
    while (!stack.empty()) {
        visit.deepestStack = std::max(visit.deepestStack, stack.size());
        const int node = stack.back();
        stack.pop_back();
        if (node < 0) {
            const int first = ~node >> 3, count = ~node & 7;
            for (int i = first; i < first + count; ++i, ++visit.triangles)
                visit.distance = std::min(visit.distance, intersect(triangles[bvh.order[i]], ray));
            continue;
        }
        for (int side = 0; side < 2; ++side, ++visit.boxes) {
            const glm::vec4* texel = &bvh.nodes[std::size_t(node) * shared::kBvhNodeTexels + 2 * side];
            if (meetsBox(texel, ray, visit.distance)) stack.push_back(std::bit_cast<int>(texel[0].w));
        }
    }
    return visit;
}

}  // namespace parhelion::soups
