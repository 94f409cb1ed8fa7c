#pragma once

#include <limits>

#include "reference/core/scene.h"
#include "reference/geometry/ray.h"

namespace parhelion::reference {

/// The surface at a hit. Normals are unit and on the side that flip_normals says.
template <typename Real>
struct Surface {
    Vec3<Real> position, geometricNormal, shadingNormal;
    Real rounding;  ///< a bound on how far `position` lies off a triangle along its normal; 0 on other shapes
    Vec2<Real> uv{0};
};

/// Unit normal of a triangle counted from the first.
/// Reference only: the shader has it within triangleSurface.
template <typename Real>
Vec3<Real> triangleNormal(const SceneView<Real>& scene, std::uint32_t triangle) {
    const Vec3<Real> v0 = scene.vertex(triangle, 0);
    return glm::normalize(glm::cross(scene.vertex(triangle, 1) - v0, scene.vertex(triangle, 2) - v0));
}

/// Unit normal of a quad or triangle.
/// Reference only: the shader has it within crossBoundary.
template <typename Real>
Vec3<Real> flatNormal(const SceneView<Real>& scene, std::uint32_t primitive) {
    if (primitive < scene.firstSphere) return scene.quads[primitive].normal;
    return triangleNormal(scene, primitive - scene.firstTriangle);
}

template <typename Real>
Vec2<Real> triangleUv(const SceneView<Real>& scene, std::uint32_t triangle, const Vec2<Real>& barycentric) {
    const glm::vec2* uv = &scene.source.triangleUvs[std::size_t(triangle) * 3];
    return (1 - barycentric.x - barycentric.y) * Vec2<Real>(uv[0]) + barycentric.x * Vec2<Real>(uv[1]) +
           barycentric.y * Vec2<Real>(uv[2]);
}

/// Position, normals and rounding of a point of a triangle.
///
/// Source of the bound: Pharr, Jakob, Humphreys 2023, "Physically Based Rendering", 4th ed., section 6.8.5.
template <typename Real>
Surface<Real> triangleSurface(const SceneView<Real>& scene, std::uint32_t triangle, const Vec2<Real>& barycentric) {
    constexpr Real kUnit = std::numeric_limits<Real>::epsilon() / 2;
    constexpr Real kGamma7 = 7 * kUnit / (1 - 7 * kUnit);
    const Vec3<Real> b{1 - barycentric.x - barycentric.y, barycentric.x, barycentric.y};
    const Vec3<Real> p0 = b.x * scene.vertex(triangle, 0);
    const Vec3<Real> p1 = b.y * scene.vertex(triangle, 1);
    const Vec3<Real> p2 = b.z * scene.vertex(triangle, 2);
    Surface<Real> surface;
    surface.position = p0 + p1 + p2;
    surface.geometricNormal = triangleNormal(scene, triangle);
    surface.shadingNormal = surface.geometricNormal;
    const Vec3<Real> error = kGamma7 * (glm::abs(p0) + glm::abs(p1) + glm::abs(p2));
    surface.rounding = glm::dot(error, glm::abs(surface.geometricNormal));
    if (!scene.source.triangleUvs.empty()) surface.uv = triangleUv(scene, triangle, barycentric);
    if (scene.source.vertexNormals.empty()) return surface;
    const glm::vec4* normals = &scene.source.vertexNormals[std::size_t(triangle) * 3];
    const Vec3<Real> n = b.x * Vec3<Real>(normals[0]) + b.y * Vec3<Real>(normals[1]) + b.z * Vec3<Real>(normals[2]);
    const Real length = glm::length(n);
    if (length > 0) surface.shadingNormal = n / length;
    return surface;
}

/// Outward unit normal of a box at a point of its surface.
template <typename Real>
Vec3<Real> boxNormal(const Box<Real>& box, const Vec3<Real>& position) {
    const Vec3<Real> local = box.localFromWorld.point(position);
    const Vec3<Real> a = glm::abs(local);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
    const glm::mat<3, 3, Real>& m = box.localFromWorld.linear;
    const Vec3<Real> n = glm::normalize(Vec3<Real>(m[0][axis], m[1][axis], m[2][axis]));
    return local[axis] < 0 ? -n : n;
}

/// Longitude and colatitude about the sphere's own z axis, as shares of a full and of a half turn.
///
/// @param normal  outwards.
template <typename Real>
Vec2<Real> sphereUv(const Sphere<Real>& sphere, const Vec3<Real>& normal) {
    const Real x = glm::dot(normal, sphere.axisX), y = glm::dot(normal, sphere.axisY);
    const Real longitude = angleOf(y, x) / (2 * kPi<Real>);
    const Real colatitude = angleOf(std::sqrt(x * x + y * y), glm::dot(normal, sphere.axisZ)) / kPi<Real>;
    return {longitude < 0 ? longitude + 1 : longitude, colatitude};
}

/// Each face of a cube shows the whole texture; which way round is Mitsuba's choice.
template <typename Real>
Vec2<Real> boxUv(const Box<Real>& box, const Vec3<Real>& position) {
    const Vec3<Real> p = box.localFromWorld.point(position);
    const Vec3<Real> a = glm::abs(p);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
    const bool isNegative = p[axis] < 0;
    const Vec2<Real> faces[3][2] = {{{p.y, -p.z}, {p.y, p.z}}, {{-p.x, -p.z}, {p.z, p.x}}, {{p.y, p.x}, {-p.y, p.x}}};
    return (faces[axis][isNegative] + Real(1)) / Real(2);
}

template <typename Real>
Surface<Real> sphereSurface(const SceneView<Real>& scene, const Sphere<Real>& sphere, const Vec3<Real>& position) {
    const Vec3<Real> outwards = glm::normalize(position - sphere.center);
    const Vec3<Real> n = scene.isFlipped(sphere.shape) ? -outwards : outwards;
    return {position, n, n, 0, sphereUv(sphere, outwards)};
}

template <typename Real>
Surface<Real> boxSurface(const SceneView<Real>& scene, const Box<Real>& box, const Vec3<Real>& position) {
    const Vec3<Real> outwards = boxNormal(box, position);
    const Vec3<Real> n = scene.isFlipped(box.shape) ? -outwards : outwards;
    return {position, n, n, 0, boxUv(box, position)};
}

template <typename Real>
Surface<Real> surfaceAt(const SceneView<Real>& scene, const Ray<Real>& ray, const Hit<Real>& hit) {
    if (hit.primitive >= scene.firstTriangle)
        return triangleSurface(scene, hit.primitive - scene.firstTriangle, hit.barycentric);
    const Vec3<Real> position = ray.origin + hit.t * ray.direction;
    if (hit.primitive >= scene.firstBox)
        return boxSurface(scene, scene.boxes[hit.primitive - scene.firstBox], position);
    if (hit.primitive >= scene.firstSphere)
        return sphereSurface(scene, scene.spheres[hit.primitive - scene.firstSphere], position);
    const Quad<Real>& quad = scene.quads[hit.primitive];
    const Vec3<Real> p = position - quad.corner;
    return {position, quad.normal, quad.normal, 0, {glm::dot(quad.uFromWorld, p), glm::dot(quad.vFromWorld, p)}};
}

}  // namespace parhelion::reference
