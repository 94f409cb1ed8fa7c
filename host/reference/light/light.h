#pragma once

#include "reference/core/frame.h"
#include "reference/geometry/intersection.h"
#include "reference/light/surrounding.h"
#include "reference/sampling/distribution.h"
#include "reference/sampling/warp.h"

namespace parhelion::reference {

/// Cosine at an area light of what leaves along `outgoing`: nothing does behind, unless the light has two sides.
template <typename Real>
Real lightCosine(const Light<Real>& light, const Vec3<Real>& normal, const Vec3<Real>& outgoing) {
    const Real cosine = glm::dot(normal, outgoing);
    return light.isTwoSided && cosine < 0 ? -cosine : std::max(Real(0), cosine);
}

/// Index of the light that u chooses: the first whose cumulative selection is above; lights.size() when none is.
template <typename Real>
std::size_t selectLight(const SceneView<Real>& scene, Real u) {
    std::size_t chosen = 0;
    while (chosen < scene.lights.size() && !(scene.lights[chosen].cumulative > u)) ++chosen;
    return chosen;
}

/// 1 - cos of the half angle under which a sphere is seen; nothing from inside.
template <typename Real>
std::optional<Real> oneMinusCosCone(const Sphere<Real>& sphere, const Vec3<Real>& position) {
    const Vec3<Real> toCenter = sphere.center - position;
    const Real sin2 = sphere.radius * sphere.radius / glm::dot(toCenter, toCenter);
    if (!(sin2 < 1)) return std::nullopt;
    return sin2 / (1 + std::sqrt(1 - sin2));
}

template <typename Real>
std::optional<LightSample<Real>> sampleSphereLight(const SceneView<Real>& scene, const Light<Real>& light,
                                                   const Vec3<Real>& position, const Vec2<Real>& u) {
    const Sphere<Real>& sphere = scene.spheres[light.primitive - scene.firstSphere];
    const std::optional<Real> cone = oneMinusCosCone(sphere, position);
    if (!cone || (scene.isFlipped(sphere.shape) && !light.isTwoSided)) return std::nullopt;
    const Frame<Real> frame = frameFromNormal(glm::normalize(sphere.center - position));
    const Vec3<Real> direction = glm::normalize(toWorld(frame, uniformCone(u, *cone)));
    const auto interval = sphereInterval(sphere, position, direction);
    // At the rim of the cone rounding may miss the sphere: it is then touched where it is nearest.
    const Real distance = interval ? interval->t0 : glm::dot(sphere.center - position, direction);
    const Real pdf = light.selection / (2 * kPi<Real> * *cone);
    return LightSample<Real>{direction, distance, light.primitive, light.emission / pdf, pdf, false};
}

/// Turns a uniform point of an area into a sample by solid angle.
template <typename Real>
std::optional<LightSample<Real>> sampleArea(const Light<Real>& light, const Vec3<Real>& position,
                                            const Vec3<Real>& point, const Vec3<Real>& normal, Real area,
                                            std::uint32_t primitive) {
    const Vec3<Real> toLight = point - position;
    const Real distance2 = glm::dot(toLight, toLight);
    if (distance2 == 0) return std::nullopt;
    const Real distance = std::sqrt(distance2);
    const Vec3<Real> direction = toLight / distance;
    const Real cosine = lightCosine(light, normal, -direction);
    if (cosine == 0) return std::nullopt;
    const Real pdf = light.selection * distance2 / (area * cosine);
    return LightSample<Real>{direction, distance, primitive, light.emission / pdf, pdf, false};
}

/// @param selector  uniform, what is left of the number that chose the light.
template <typename Real>
std::optional<LightSample<Real>> sampleMeshLight(const SceneView<Real>& scene, const Light<Real>& light,
                                                 const Vec3<Real>& position, Real selector, const Vec2<Real>& u) {
    const std::span<const float> cdf(&scene.source.lightTriangleCdf[light.cdfOffset], light.triangleCount);
    const std::uint32_t primitive = scene.source.lightTriangles[light.cdfOffset + firstAbove(cdf, selector)];
    const std::uint32_t triangle = primitive - scene.firstTriangle;
    const Vec3<Real> b = uniformTriangle(u);
    const Vec3<Real> point =
        b.x * scene.vertex(triangle, 0) + b.y * scene.vertex(triangle, 1) + b.z * scene.vertex(triangle, 2);
    return sampleArea(light, position, point, triangleNormal(scene, triangle), light.area, primitive);
}

/// Reference only: within sampleLight in the shader.
template <typename Real>
std::optional<LightSample<Real>> sampleDeltaLight(const Light<Real>& light, const Vec3<Real>& position) {
    if (light.type == shared::kLightDirectional)
        return LightSample<Real>{-light.vector, kInfinity<Real>, kNone, light.emission / light.selection, 0, true};
    const Vec3<Real> toLight = light.vector - position;
    const Real distance2 = glm::dot(toLight, toLight);
    if (distance2 == 0) return std::nullopt;
    const Real distance = std::sqrt(distance2);
    return LightSample<Real>{
        toLight / distance, distance, kNone, light.emission / (distance2 * light.selection), 0, true};
}

/// Chooses one light and a point of it.
///
/// @param u      which light; the light point.
/// @param words  the environment draw: the point of a map or a sky; others do without.
/// @return nothing when no light is sampled, or the one chosen sends nothing this way.
template <typename Real>
std::optional<LightSample<Real>> sampleLight(const SceneView<Real>& scene, const Vec3<Real>& position,
                                             const Vec3<Real>& u, const glm::uvec4& words = glm::uvec4(0)) {
    const std::size_t chosen = selectLight(scene, u.x);
    if (chosen == scene.lights.size()) return std::nullopt;
    const Light<Real>& light = scene.lights[chosen];
    const Vec2<Real> uv{u.y, u.z};
    switch (light.type) {
        case shared::kLightQuad: {
            const Quad<Real>& quad = scene.quads[light.primitive];
            const Vec3<Real> point = quad.corner + uv.x * quad.edgeU + uv.y * quad.edgeV;
            return sampleArea(light, position, point, quad.normal, quad.area, light.primitive);
        }
        case shared::kLightSphere:
            return sampleSphereLight(scene, light, position, uv);
        case shared::kLightMesh: {
            constexpr Real kBelowOne = 1 - std::numeric_limits<Real>::epsilon() / 2;
            const Real before = chosen == 0 ? Real(0) : scene.lights[chosen - 1].cumulative;
            const Real selector = std::min((u.x - before) / light.selection, kBelowOne);
            return sampleMeshLight(scene, light, position, selector, uv);
        }
        case shared::kLightEnvironment:
        case shared::kLightEnvironmentMap:
        case shared::kLightSky:
            return sampleSurrounding(scene, light, uv, words);
        default:
            return sampleDeltaLight(light, position);
    }
}

/// Density, per steradian and selection included, with which sampleLight at `origin` chooses the light met at
/// `distance` along `direction`, where the light's normal is `normal`. Infinite distance: the environment.
template <typename Real>
Real lightPdf(const SceneView<Real>& scene, const Light<Real>& light, const Vec3<Real>& origin,
              const Vec3<Real>& direction, Real distance, const Vec3<Real>& normal) {
    if (light.selection == 0) return 0;
    if (light.type == shared::kLightEnvironment) return light.selection / (4 * kPi<Real>);
    if (light.type == shared::kLightEnvironmentMap) return light.selection * environmentAt(scene, direction).pdf;
    if (light.type == shared::kLightSky)
        return light.selection * skyPdf(scene, SkyPoint<Real>{direction, findStar(scene, direction)});
    if (light.type == shared::kLightSphere) {
        const auto cone = oneMinusCosCone(scene.spheres[light.primitive - scene.firstSphere], origin);
        return cone ? light.selection / (2 * kPi<Real> * *cone) : Real(0);
    }
    const Real area = light.type == shared::kLightQuad ? scene.quads[light.primitive].area : light.area;
    return light.selection * distance * distance / (area * lightCosine(light, normal, -direction));
}

}  // namespace parhelion::reference
