#pragma once

#include "reference/integrator/direct_lighting.h"
#include "reference/integrator/film.h"

namespace parhelion::reference {

/// A path between two of its vertices.
template <typename Real>
struct PathState {
    Ray<Real> ray;
    Residual<Real> residual;
    Throughput<Real> throughput{};
    Vec3<Real> radiance{0};
    Real lastPdf = kInfinity<Real>;  ///< of the ray's direction, times the samples of scattering; infinite from the
                                     ///< camera: no light sample competes
    std::uint32_t scatterings = 0;
    shared::LayerPixel* layers = nullptr;  ///< the pixel's, if the film has any
};

/// Adds what a path of some scatterings brings. What is not finite is left to the sample's sum, which reports it.
template <typename Real>
void addRadiance(const SceneView<Real>& scene, std::uint32_t scatterings, const Vec3<Real>& gain,
                 PathState<Real>& state) {
    state.radiance += gain;
    if (!state.layers || !std::isfinite(gain.x + gain.y + gain.z)) return;
    shared::LayerPixel& layer = state.layers[std::min(scatterings, scene.constants.depthLayers - 1)];
    for (int c = 0; c < 3; ++c) addCompensated(layer.sumHigh[c], layer.sumLow[c], gain[c]);
}

/// Adds emission met at the end of a flight, weighted against light sampling at its start.
template <typename Real>
void addEmission(const SceneView<Real>& scene, const Light<Real>& light, std::uint32_t primitive,
                 const Vec3<Real>& emission, Real distance, Real cosine, PathState<Real>& state) {
    const Real pdf = lightPdf(scene, light, primitive, state.ray.origin, state.ray.direction, distance, cosine);
    const Real mis = emissionWeight(state.lastPdf, pdf * Real(scene.constants.emitterSamples));
    const Vec3<Real> gain = state.throughput.beta * emission * (mis / state.throughput.meanR());
    addRadiance(scene, state.scatterings, gain, state);
}

/// Adds what comes from beyond the scene.
template <typename Real>
void addEnvironment(const SceneView<Real>& scene, PathState<Real>& state) {
    if (scene.constants.environment == kNone) return;
    const Light<Real>& light = scene.lights[scene.constants.environment];
    const Vec3<Real>& direction = state.ray.direction;
    Vec3<Real> radiance = light.emission;
    if (light.type == shared::kLightEnvironmentMap) radiance = environmentAt(scene, direction).radiance;
    if (light.type == shared::kLightSky)
        radiance = skyRadiance(scene, SkyPoint<Real>{direction, findStar(scene, direction)});
    addEmission(scene, light, kNone, radiance, kInfinity<Real>, Real(1), state);
}

}  // namespace parhelion::reference
