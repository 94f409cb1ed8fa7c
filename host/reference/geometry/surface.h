#pragma once

#include <algorithm>
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
    Real slack = -1;        ///< quads and triangles: how far a ray's start may lie off it
    Vec2<Real> weights{0};  ///< quads and triangles: of the second and third corner in the position

    /// Reference only: the shader writes them into the path state.
    typename Ray<Real>::Start start() const { return {weights, slack}; }
};

/// Relative error of a sum of three products.
template <typename Real>
inline constexpr Real kGamma7 = Real(3.5) * std::numeric_limits<Real>::epsilon();

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

/// Moves a point that is next to an edge of a triangle, four times its own rounding or less away, towards the middle.
/// Reference only: within triangleSurface in the shader.
///
/// @param b  barycentrics of the point.
template <typename Real>
void moveOffEdges(const SceneView<Real>& scene, std::uint32_t triangle, Vec3<Real>& b) {
    const Vec3<Real> corners[3] = {scene.vertex(triangle, 0), scene.vertex(triangle, 1), scene.vertex(triangle, 2)};
    const Vec3<Real> edges[3] = {corners[2] - corners[1], corners[0] - corners[2], corners[1] - corners[0]};
    const int nearest = b.x <= b.y && b.x <= b.z ? 0 : (b.y <= b.z ? 1 : 2);
    const Real longest = std::max({glm::length(edges[0]), glm::length(edges[1]), glm::length(edges[2])});
    const Real height = glm::length(glm::cross(edges[2], edges[1])) / longest, distance = b[nearest] * height;
    const Vec3<Real> terms = glm::abs(b.x * corners[0]) + glm::abs(b.y * corners[1]) + glm::abs(b.z * corners[2]);
    const Real rounding = kGamma7<Real> * (maxComponent(terms) + longest);
    if (distance >= 4 * rounding) return;
    const Real share = std::min(Real(0.5), 12 * rounding / height), third = Real(1) / 3;
    b.y += share * (third - b.y);
    b.z += share * (third - b.z);
    b.x = 1 - b.y - b.z;
}

/// Position, normals and rounding of a point of a triangle.
///
/// Source of the bound: Pharr, Jakob, Humphreys 2023, "Physically Based Rendering", 4th ed., section 6.8.5.
template <typename Real>
Surface<Real> triangleSurface(const SceneView<Real>& scene, std::uint32_t triangle, const Vec2<Real>& barycentric) {
    Vec3<Real> b{1 - barycentric.x - barycentric.y, barycentric.x, barycentric.y};
    Surface<Real> surface;
    moveOffEdges(scene, triangle, b);
    const Vec3<Real> p0 = b.x * scene.vertex(triangle, 0);
    const Vec3<Real> p1 = b.y * scene.vertex(triangle, 1);
    const Vec3<Real> p2 = b.z * scene.vertex(triangle, 2);
    surface.position = p0 + p1 + p2;
    surface.geometricNormal = triangleNormal(scene, triangle);
    surface.shadingNormal = surface.geometricNormal;
    const Vec3<Real> error = kGamma7<Real> * (glm::abs(p0) + glm::abs(p1) + glm::abs(p2));
    surface.rounding = glm::dot(error, glm::abs(surface.geometricNormal));
    surface.slack = 2 * surface.rounding;
    surface.weights = {b.y, b.z};
    if (!scene.source.triangleUvs.empty()) surface.uv = triangleUv(scene, triangle, Vec2<Real>(b.y, b.z));
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

/// Reference only: within surfaceAt in the shader.
template <typename Real>
Surface<Real> quadSurface(const Quad<Real>& quad, const Vec3<Real>& position) {
    const Vec3<Real> p = position - quad.corner;
    const Vec2<Real> computed(glm::dot(quad.uFromWorld, p), glm::dot(quad.vFromWorld, p));
    const Vec2<Real> uv = glm::clamp(computed, Real(0), Real(1));
    // Its own rounding or less from an edge, the point is moved twice as far off it.
    const auto moved = [&](Real at, Real length) {
        const Real rounding = kGamma7<Real> * (maxComponent(glm::abs(position)) + length);
        if (std::min(at, 1 - at) * length >= rounding) return at;
        return at + std::min(Real(0.5), 4 * rounding / length) * (Real(0.5) - at);
    };
    const Vec2<Real> to(moved(uv.x, glm::length(quad.edgeU)), moved(uv.y, glm::length(quad.edgeV)));
    const Vec3<Real> onto = position + (to.x - computed.x) * quad.edgeU + (to.y - computed.y) * quad.edgeV;
    Surface<Real> surface{onto, quad.normal, quad.normal, 0, uv};
    surface.weights = to;
    surface.slack = std::abs(glm::dot(quad.normal, p)) +
                    Real(2.5) * std::numeric_limits<Real>::epsilon() * glm::dot(glm::abs(quad.normal), glm::abs(p));
    return surface;
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
    return quadSurface(scene.quads[hit.primitive], position);
}

}  // namespace parhelion::reference
