#pragma once

#include <optional>

#include "reference/light/environment.h"
#include "reference/light/light_sample.h"
#include "reference/light/sky.h"
#include "reference/sampling/warp.h"

namespace parhelion::reference {

/// A direction towards a light that surrounds the scene; nothing where it has no density.
///
/// @param words  x, y and z of a light draw.
template <typename Real>
std::optional<LightSample<Real>> sampleSurrounding(const SceneView<Real>& scene, const Light<Real>& light,
                                                   const glm::uvec3& words) {
    Vec3<Real> direction = uniformSphere(Vec2<Real>{toUniform<Real>(words.x), toUniform<Real>(words.y)});
    Vec3<Real> radiance = light.emission;
    Real pdf = 1 / (4 * kPi<Real>);
    if (light.type == shared::kLightEnvironmentMap) {
        const EnvironmentSample<Real> point = sampleEnvironment(scene, words);
        direction = point.direction;
        radiance = environmentAt(scene, point.direction).radiance;
        pdf = point.pdf;
    }
    if (light.type == shared::kLightSky) {
        const SkyPoint<Real> point = sampleSky(scene, words);
        direction = point.direction;
        radiance = skyRadiance(scene, point);
        pdf = skyPdf(scene, point);
    }
    pdf *= light.selection;
    if (pdf == 0) return std::nullopt;
    return LightSample<Real>{direction, kInfinity<Real>, kNone, radiance / pdf, pdf, false};
}

}  // namespace parhelion::reference
