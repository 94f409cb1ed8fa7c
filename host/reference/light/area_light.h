#pragma once

#include <optional>

#include "reference/core/frame.h"
#include "reference/geometry/intersection.h"
#include "reference/light/light_sample.h"
#include "reference/sampling/distribution.h"
#include "reference/sampling/sampler.h"
#include "reference/sampling/warp.h"
#include "reference/surface/texture.h"

namespace parhelion::reference {

/// Cosine at an area light of what leaves along `outgoing`: nothing does behind the shading normal, as in Mitsuba,
/// unless the light has two sides.
template <typename Real>
Real lightCosine(const Light<Real>& light, const Vec3<Real>& geometricNormal, const Vec3<Real>& shadingNormal,
                 const Vec3<Real>& outgoing) {
    if (!light.isTwoSided && !(glm::dot(shadingNormal, outgoing) > 0)) return 0;
    return std::abs(glm::dot(geometricNormal, outgoing));
}

/// Radiance of an area light at (u, v) of its surface.
template <typename Real>
Vec3<Real> emissionAt(const SceneView<Real>& scene, const Light<Real>& light, const Vec2<Real>& uv) {
    return light.emission * textureAt(scene.source, light.texture, uv);
}

/// 1 - cos of the half angle under which a sphere is seen; nothing from inside, and from so close that rounding could
/// take a point of the sphere for one outside.
template <typename Real>
std::optional<Real> oneMinusCosCone(const Sphere<Real>& sphere, const Vec3<Real>& position) {
    const Vec3<Real> toCenter = sphere.center - position;
    const Real sin2 = sphere.radius * sphere.radius / glm::dot(toCenter, toCenter);
    if (!(sin2 < Real(shared::kFarthestCone))) return std::nullopt;
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
    const Vec3<Real> normal = glm::normalize(position + distance * direction - sphere.center);
    const Vec3<Real> radiance = emissionAt(scene, light, sphereUv(sphere, normal));
    return LightSample<Real>{direction, distance, light.primitive, radiance / pdf, pdf, false};
}

/// Turns a uniform point of an area into a sample by solid angle.
template <typename Real>
std::optional<LightSample<Real>> sampleArea(const SceneView<Real>& scene, const Light<Real>& light,
                                            const Vec3<Real>& position, const Vec3<Real>& point, const Vec2<Real>& uv,
                                            const Vec3<Real>& geometricNormal, const Vec3<Real>& shadingNormal,
                                            Real area, std::uint32_t primitive) {
    const Vec3<Real> toLight = point - position;
    const Real distance2 = glm::dot(toLight, toLight);
    if (distance2 == 0) return std::nullopt;
    const Real distance = std::sqrt(distance2);
    const Vec3<Real> direction = toLight / distance;
    const Real cosine = lightCosine(light, geometricNormal, shadingNormal, -direction);
    if (cosine == 0) return std::nullopt;
    const Real pdf = light.selection * distance2 / (area * cosine);
    return LightSample<Real>{direction, distance, primitive, emissionAt(scene, light, uv) / pdf, pdf, false};
}

/// Inverse of the density, per unit of area, with which sampleMeshLight finds the points of a triangle.
template <typename Real>
Real meshArea(const SceneView<Real>& scene, std::uint32_t primitive) {
    return scene.source.triangleAreas[primitive - scene.firstTriangle];
}

/// @param words  x, y and z of a light draw, what chose the light taken out.
template <typename Real>
std::optional<LightSample<Real>> sampleMeshLight(const SceneView<Real>& scene, const Light<Real>& light,
                                                 const Vec3<Real>& position, const glm::uvec3& words) {
    const auto table = std::span(scene.source.distributions).subspan(light.distribution, light.triangleCount + 1);
    const Choice<Real> choice = invertDistribution(table, words.x, fillDigits<Real>(words.z).x);
    const std::uint32_t primitive = scene.source.lightTriangles[light.triangleOffset + choice.entry];
    const std::uint32_t triangle = primitive - scene.firstTriangle;
    const Vec3<Real> b = uniformTriangle(Vec2<Real>{choice.offset, toUniform<Real>(words.y)});
    const Surface<Real> surface = triangleSurface(scene, triangle, Vec2<Real>(b.y, b.z));
    return sampleArea(scene, light, position, surface.position, surface.uv, surface.geometricNormal,
                      surface.shadingNormal, meshArea(scene, primitive), primitive);
}

}  // namespace parhelion::reference
