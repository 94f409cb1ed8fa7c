#include "compile/containment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace parhelion {

namespace {

using Kind = PlacedShape::Kind;

/// Lengths below this count as touching.
double toleranceOf(const PlacedShape& a, const PlacedShape& b) {
    const glm::dvec3 size = glm::max(a.upper - a.lower, b.upper - b.lower);
    return 1e-6 * std::max({size.x, size.y, size.z});
}

struct Interval {
    double low = std::numeric_limits<double>::infinity(), high = -low;
};

Interval project(const PlacedShape& box, const glm::dvec3& axis) {
    Interval result;
    for (const glm::dvec3& vertex : box.vertices) {
        result.low = std::min(result.low, glm::dot(vertex, axis));
        result.high = std::max(result.high, glm::dot(vertex, axis));
    }
    return result;
}

bool separates(const PlacedShape& a, const PlacedShape& b, const glm::dvec3& axis, double tolerance) {
    const double length = glm::length(axis);
    if (length <= 0.0) return false;
    const Interval p = project(a, axis / length), q = project(b, axis / length);
    return p.high <= q.low + tolerance || q.high <= p.low + tolerance;
}

/// Unit normal of the two faces that local axis `axis` pierces.
glm::dvec3 faceNormal(const PlacedShape& box, int axis) {
    const glm::dmat3 m(box.toScene);
    return glm::normalize(glm::cross(m[(axis + 1) % 3], m[(axis + 2) % 3]));
}

/// Separating axes of two parallelepipeds (they may be sheared): 3 + 3 face normals, 9 products of edges.
bool boxesApart(const PlacedShape& a, const PlacedShape& b) {
    const double tolerance = toleranceOf(a, b);
    for (int i = 0; i < 3; ++i) {
        if (separates(a, b, faceNormal(a, i), tolerance) || separates(a, b, faceNormal(b, i), tolerance)) return true;
        for (int j = 0; j < 3; ++j) {
            const glm::dvec3 p = glm::normalize(glm::dvec3(a.toScene[i])), q = glm::normalize(glm::dvec3(b.toScene[j]));
            const glm::dvec3 axis = glm::cross(p, q);
            // The product of nearly parallel edges is noise, and the face normals decide for those.
            if (glm::dot(axis, axis) > 1e-16 && separates(a, b, axis, tolerance)) return true;
        }
    }
    return false;
}

/// Distance from `point` to the parallelogram center + s u + t v, s and t in [-1, 1].
double distanceToFace(const glm::dvec3& point, const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) {
    const glm::dvec3 d = point - center, n = glm::cross(u, v);
    const double s = glm::dot(glm::cross(d, v), n) / glm::dot(n, n);
    const double t = glm::dot(glm::cross(u, d), n) / glm::dot(n, n);
    if (std::abs(s) <= 1.0 && std::abs(t) <= 1.0) return std::abs(glm::dot(d, n)) / glm::length(n);
    double best = std::numeric_limits<double>::infinity();
    const auto tryEdge = [&](const glm::dvec3& middle, const glm::dvec3& half) {
        const double along = std::clamp(glm::dot(d - middle, half) / glm::dot(half, half), -1.0, 1.0);
        best = std::min(best, glm::distance(d, middle + along * half));
    };
    for (const double side : {-1.0, 1.0}) {
        tryEdge(side * u, v);
        tryEdge(side * v, u);
    }
    return best;
}

double distanceToSurface(const PlacedShape& box, const glm::dvec3& point) {
    double best = std::numeric_limits<double>::infinity();
    const glm::dmat3 m(box.toScene);
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0})
            best = std::min(best, distanceToFace(point, glm::dvec3(box.toScene[3]) + side * m[axis], m[(axis + 1) % 3],
                                                 m[(axis + 2) % 3]));
    return best;
}

bool boundsApart(const PlacedShape& a, const PlacedShape& b) {
    const double tolerance = toleranceOf(a, b);
    for (int axis = 0; axis < 3; ++axis)
        if (a.upper[axis] <= b.lower[axis] + tolerance || b.upper[axis] <= a.lower[axis] + tolerance) return true;
    return false;
}

glm::dvec3 localPoint(const glm::dmat4& localFromScene, const glm::dvec3& point) {
    return glm::dvec3(localFromScene * glm::dvec4(point, 1.0));
}

/// Crossings of the ray from `point` with the mesh (Moller and Trumbore 1997, in double).
bool oddCrossings(const PlacedShape& mesh, const glm::dvec3& point, const glm::dvec3& direction) {
    bool odd = false;
    for (const glm::uvec3& index : mesh.triangles) {
        const glm::dvec3 a = mesh.vertices[index.x];
        const glm::dvec3 e1 = mesh.vertices[index.y] - a, e2 = mesh.vertices[index.z] - a;
        const glm::dvec3 p = glm::cross(direction, e2);
        const double determinant = glm::dot(e1, p);
        if (determinant == 0.0) continue;
        const glm::dvec3 s = point - a, q = glm::cross(s, e1);
        const double u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant;
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && glm::dot(e2, q) / determinant > 0.0) odd = !odd;
    }
    return odd;
}

}  // namespace

bool containsPoint(const PlacedShape& shape, const glm::dvec3& point) {
    if (shape.kind == Kind::Quad) return false;
    if (shape.kind == Kind::Sphere) return glm::distance(point, shape.center) < shape.radius;
    if (shape.kind == Kind::Box) {
        const glm::dvec3 local = glm::abs(localPoint(glm::inverse(shape.toScene), point));
        return std::max({local.x, local.y, local.z}) < 1.0;
    }
    if (glm::any(glm::lessThan(point, shape.lower)) || glm::any(glm::greaterThan(point, shape.upper))) return false;
    // Directions that no modeller aligns edges with; a graze spoils one of them at most.
    const std::array<glm::dvec3, 3> directions = {
        {{0.5377, 0.8339, -0.2588}, {-0.8622, 0.3188, 0.4277}, {0.1326, -0.5436, 0.8262}}};
    int votes = 0;
    for (const glm::dvec3& direction : directions) votes += oddCrossings(shape, point, direction);
    return votes >= 2;
}

bool areApart(const PlacedShape& a, const PlacedShape& b) {
    if (!a.isAnalyticSolid() || !b.isAnalyticSolid()) return boundsApart(a, b);
    const double tolerance = toleranceOf(a, b);
    if (a.kind == Kind::Sphere && b.kind == Kind::Sphere)
        return glm::distance(a.center, b.center) >= a.radius + b.radius - tolerance;
    if (a.kind == Kind::Box && b.kind == Kind::Box) return boxesApart(a, b);
    const PlacedShape& sphere = a.kind == Kind::Sphere ? a : b;
    const PlacedShape& box = a.kind == Kind::Sphere ? b : a;
    return !containsPoint(box, sphere.center) && distanceToSurface(box, sphere.center) >= sphere.radius - tolerance;
}

bool encloses(const PlacedShape& outer, const PlacedShape& inner) {
    const double tolerance = toleranceOf(outer, inner);
    if (glm::any(glm::lessThan(inner.lower, outer.lower - tolerance)) ||
        glm::any(glm::greaterThan(inner.upper, outer.upper + tolerance)))
        return false;
    if (!outer.isAnalyticSolid()) return outer.kind == Kind::Mesh;
    if (outer.kind == Kind::Sphere && inner.kind == Kind::Sphere)
        return glm::distance(outer.center, inner.center) + inner.radius <= outer.radius + tolerance;
    if (outer.kind == Kind::Sphere)
        return std::ranges::all_of(inner.vertices, [&](const glm::dvec3& vertex) {
            return glm::distance(outer.center, vertex) <= outer.radius + tolerance;
        });
    const double innerRadius = inner.kind == Kind::Sphere ? inner.radius : 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 normal = faceNormal(outer, axis);
        const double middle = glm::dot(glm::dvec3(outer.toScene[3]), normal);
        const double half = std::abs(glm::dot(glm::dvec3(outer.toScene[axis]), normal)) + tolerance;
        const Interval extent = inner.kind == Kind::Sphere
                                    ? Interval{glm::dot(inner.center, normal), glm::dot(inner.center, normal)}
                                    : project(inner, normal);
        if (extent.low - innerRadius < middle - half || extent.high + innerRadius > middle + half) return false;
    }
    return true;
}

}  // namespace parhelion
