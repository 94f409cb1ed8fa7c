#pragma once

#include <optional>

#include "reference/light/area_light.h"
#include "reference/light/surrounding.h"

namespace parhelion::reference {

/// Index of the light that u chooses: the first whose cumulative selection is above; lights.size() when none is.
template <typename Real>
std::size_t selectLight(const SceneView<Real>& scene, Real u) {
    std::size_t chosen = 0;
    while (chosen < scene.lights.size() && !(scene.lights[chosen].cumulative > u)) ++chosen;
    return chosen;
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
/// @param words  x, y and z of a light draw: (x, y) is one point over all lights and what is on each; z has digits to
///               spare.
/// @return nothing when no light is sampled, or the one chosen sends nothing this way.
template <typename Real>
std::optional<LightSample<Real>> sampleLight(const SceneView<Real>& scene, const Vec3<Real>& position,
                                             glm::uvec3 words) {
    const std::size_t chosen = selectLight(scene, toUniform<Real>(words.x));
    if (chosen == scene.lights.size()) return std::nullopt;
    const Light<Real>& light = scene.lights[chosen];
    const auto wordsOf = [](Real probability) { return std::uint32_t(std::uint64_t(double(probability) * 0x1p32)); };
    const std::uint32_t below = chosen == 0 ? 0 : wordsOf(scene.lights[chosen - 1].cumulative);
    const glm::uvec2 zoomed = zoomWord({words.x, words.z}, below, wordsOf(light.selection));
    words = {zoomed.x, words.y, zoomed.y};
    const Vec2<Real> uv{toUniform<Real>(words.x), toUniform<Real>(words.y)};
    switch (light.type) {
        case shared::kLightQuad: {
            const Quad<Real>& quad = scene.quads[light.primitive];
            const Vec3<Real> point = quad.corner + uv.x * quad.edgeU + uv.y * quad.edgeV;
            return sampleArea(scene, light, position, point, uv, quad.normal, quad.normal, quad.area, light.primitive);
        }
        case shared::kLightSphere:
            return sampleSphereLight(scene, light, position, uv);
        case shared::kLightMesh:
            return sampleMeshLight(scene, light, position, words);
        case shared::kLightEnvironment:
        case shared::kLightEnvironmentMap:
        case shared::kLightSky:
            return sampleSurrounding(scene, light, words);
        default:
            return sampleDeltaLight(light, position);
    }
}

/// Density, per steradian and selection included, with which sampleLight at `origin` chooses the light met at
/// `distance` along `direction` under `cosine` (see lightCosine). Infinite distance: the environment.
///
/// @param primitive  which one of the light's was met.
template <typename Real>
Real lightPdf(const SceneView<Real>& scene, const Light<Real>& light, std::uint32_t primitive, const Vec3<Real>& origin,
              const Vec3<Real>& direction, Real distance, Real cosine) {
    if (light.selection == 0) return 0;
    if (light.type == shared::kLightEnvironment) return light.selection / (4 * kPi<Real>);
    if (light.type == shared::kLightEnvironmentMap) return light.selection * environmentAt(scene, direction).pdf;
    if (light.type == shared::kLightSky)
        return light.selection * skyPdf(scene, SkyPoint<Real>{direction, findStar(scene, direction)});
    if (light.type == shared::kLightSphere) {
        const auto cone = oneMinusCosCone(scene.spheres[light.primitive - scene.firstSphere], origin);
        return cone ? light.selection / (2 * kPi<Real> * *cone) : Real(0);
    }
    const Real area = light.type == shared::kLightQuad ? scene.quads[light.primitive].area : meshArea(scene, primitive);
    return light.selection * distance * distance / (area * cosine);
}

}  // namespace parhelion::reference
