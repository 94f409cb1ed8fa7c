#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "reference/core/scene.h"
#include "reference/geometry/ray.h"

namespace parhelion::reference {

/// Whether it is a quad or a triangle.
template <typename Real>
bool isFlatPrimitive(const SceneView<Real>& scene, std::uint32_t primitive) {
    return primitive != kNone && (primitive < scene.firstSphere || primitive >= scene.firstTriangle);
}

/// Corners of a quad or triangle.
template <typename Real>
struct Face {
    std::array<Vec3<Real>, 4> corners;
    int count;

    /// Reference only: spelt out where the shader needs it.
    bool hasCorner(const Vec3<Real>& point) const {
        return std::find(corners.begin(), corners.begin() + 3, point) != corners.begin() + 3;
    }
};

/// Reference only: the shader has it from the surface.
template <typename Real>
Face<Real> faceOf(const SceneView<Real>& scene, std::uint32_t primitive) {
    if (primitive < scene.firstSphere) {
        const Quad<Real>& quad = scene.quads[primitive];
        const Vec3<Real> b = quad.corner + quad.edgeU, c = quad.corner + quad.edgeV;
        return {{quad.corner, b, c, b + (c - quad.corner)}, 4};
    }
    const std::uint32_t triangle = primitive - scene.firstTriangle;
    return {{scene.vertex(triangle, 0), scene.vertex(triangle, 1), scene.vertex(triangle, 2)}, 3};
}

/// A plane through a point.
template <typename Real>
struct Plane {
    Vec3<Real> at, normal;  ///< normal: unit
    Real spread;            ///< how many times a rounding of its edges the normal's error is
};

/// The plane of a face, taken from the corner opposite to the longest edge. The cross product of a long edge of a
/// sliver with another long one would have few digits.
template <typename Real>
Plane<Real> planeOf(const Face<Real>& face) {
    const auto& c = face.corners;
    Real longest = -1;
    int at = 0;
    for (int i = 0; i < 3; ++i) {
        const Vec3<Real> opposite = c[(i + 2) % 3] - c[(i + 1) % 3];
        if (glm::dot(opposite, opposite) > longest) {
            longest = glm::dot(opposite, opposite);
            at = i;
        }
    }
    const Vec3<Real> u = c[(at + 1) % 3] - c[at], v = c[(at + 2) % 3] - c[at], normal = glm::cross(u, v);
    const Real area = glm::length(normal);
    return {c[at], normal / area, glm::length(u) * glm::length(v) / area};
}

/// Signed distance with a bound of its error.
template <typename Real>
struct Distance {
    Real value = 0, error = 0;

    /// Reference only: spelt out where the shader needs it, as the next two.
    bool isAbove() const { return value > error; }
    /// Reference only: as above.
    bool isBelow() const { return value < -error; }
    /// Reference only: as above.
    bool isDecided() const { return isAbove() || isBelow(); }
};

/// The error of a distance from a plane, in units of a spread times a length.
template <typename Real>
inline constexpr Real kFlatError = 4 * std::numeric_limits<Real>::epsilon();

/// From the plane of a face. Its own corners lie in it, whatever the rounding.
template <typename Real>
Distance<Real> planeDistance(const Plane<Real>& plane, const Face<Real>& face, const Vec3<Real>& point) {
    if (face.hasCorner(point)) return {};
    const Vec3<Real> offset = point - plane.at;
    return {glm::dot(plane.normal, offset),
            kFlatError<Real> * (plane.spread * glm::length(offset) + glm::length(point))};
}

/// Of the start of a ray next to the face: measured from the closest exact corner, nearly without rounding.
template <typename Real>
Distance<Real> startDistance(const Plane<Real>& plane, const Face<Real>& face, const Vec3<Real>& origin) {
    Vec3<Real> offset = origin - face.corners[0];
    if (face.count == 3)
        for (int i = 1; i < 3; ++i) {
            const Vec3<Real> other = origin - face.corners[i];
            if (glm::dot(other, other) < glm::dot(offset, offset)) offset = other;
        }
    return {glm::dot(plane.normal, offset), kFlatError<Real> * plane.spread * glm::length(offset)};
}

/// Whether the ray goes on past the opaque flat primitive it has hit: one that it starts in within rounding and does
/// not go into.
template <typename Real>
bool leavesAside(const SceneView<Real>& scene, const Ray<Real>& ray, const Hit<Real>& hit) {
    if (!hit.near) return false;
    const Face<Real> left = faceOf(scene, ray.last), met = faceOf(scene, hit.primitive);
    const Plane<Real> leftPlane = planeOf(left), metPlane = planeOf(met);
    const bool goesUp = glm::dot(leftPlane.normal, ray.direction) >= 0;
    const Real heading = glm::dot(metPlane.normal, ray.direction);
    const auto isAhead = [&](Real distance) { return distance * heading < 0; };

    bool rises = false;
    for (int i = 0; i < met.count; ++i) {
        const Distance<Real> d = planeDistance(leftPlane, left, met.corners[i]);
        rises = rises || (goesUp ? d.isAbove() : d.isBelow());
    }
    const Vec2<Real>& w = ray.start.weights;
    const Real weights[3] = {1 - w.x - w.y, w.x, w.y};
    Distance<Real> ideal, middle;
    bool hasAbove = false, hasBelow = false;
    for (int i = 0; i < 3; ++i) {
        const Distance<Real> d = planeDistance(metPlane, met, left.corners[i]);
        ideal = {ideal.value + weights[i] * d.value, ideal.error + std::abs(weights[i]) * d.error};
        middle = {middle.value + d.value, middle.error + d.error};
        hasAbove = hasAbove || d.isAbove();
        hasBelow = hasBelow || d.isBelow();
    }
    const bool straddles = hasAbove && hasBelow;
    const Distance<Real> start = startDistance(metPlane, met, ray.origin);
    if (!rises) return !(ideal.isDecided() && !isAhead(ideal.value) && start.isDecided() && isAhead(start.value));
    if (ideal.isDecided() && !straddles) return !isAhead(ideal.value);
    if (start.isDecided()) return !isAhead(start.value);
    if (straddles) return !(hit.t > 0);
    return !(middle.isDecided() && isAhead(middle.value));
}

}  // namespace parhelion::reference
