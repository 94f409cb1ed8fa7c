#pragma once

#include "reference/integrator/emission.h"

namespace parhelion::reference {

/// Where a path's flight ends.
template <typename Real>
struct FlightEnd {
    enum class Kind { Escape, Surface, Medium, Truncated } kind;
    Hit<Real> hit{};                       ///< Surface
    const Medium<Real>* medium = nullptr;  ///< Medium
    Real t = 0;                            ///< Medium
};

/// Absorption, roulette, direct light and the next direction at a vertex.
///
/// @param albedo  albedo or reflectance.
/// @return whether the path goes on.
template <typename Real, typename Trace>
bool scatter(const PathContext<Real, Trace>& path, const Vertex<Real>& vertex, const Vec3<Real>& albedo,
             PathState<Real>& state) {
    Throughput<Real>& throughput = state.throughput;
    throughput.beta *= albedo;
    const Real largest = maxComponent(throughput.beta);
    if (largest == 0) return false;
    const glm::uvec4 words = drawStratified(path.stream, path.quality.sobol, vertex.index, shared::kDrawScatter);
    const Real weight = largest / throughput.meanR();
    // Far below what a film resolves, roulette at any depth: throughput must not sink into denormals (H37).
    if (vertex.index >= path.scene.constants.rouletteDepth || weight < Real(1e-20)) {
        const Real survival = std::clamp(weight, Real(0.05), Real(1));
        const Real u = toUniform<Real>(words.w);
        if constexpr (Trace::kIsOn)
            path.trace.add(Decision{Decision::Kind::PathRoulette, vertex.index, 0, 0, double(u), double(survival)});
        if (!(u < survival)) return false;
        throughput.beta /= survival;
    }
    const Vec3<Real> gain = throughput.beta * estimateDirect(path, vertex) / throughput.meanR();
    addRadiance(path.scene, vertex.index, gain, state);
    const DirectionSample<Real> next = sampleScatterer(vertex, glm::uvec2(words));
    state.ray = spawnRay(vertex, next.direction);
    state.lastPdf = next.pdf * Real(path.scene.constants.scatterSamples);
    state.residual = {exponential<Real>(words.z, spareBits(words.x, words.y, words.w))};
    state.scatterings = vertex.index;
    return true;
}

/// Emission and scattering at an opaque surface.
///
/// @return whether the path goes on: not from behind a one-sided surface.
template <typename Real, typename Trace>
bool surfaceVertex(const PathContext<Real, Trace>& path, const Hit<Real>& hit, Vertex<Real>& vertex,
                   PathState<Real>& state) {
    const SceneView<Real>& scene = path.scene;
    const shared::Shape& shape = scene.shapeAt(hit.shape);
    vertex.surface = surfaceAt(scene, state.ray, hit);
    vertex.position = vertex.surface.position;
    vertex.primitive = hit.primitive;
    const Vec3<Real> reflectance = reflectanceAt(scene.source, shape, vertex.surface.uv);
    vertex.strength = maxComponent(reflectance);
    Surface<Real>& surface = vertex.surface;
    if (shape.light != kNone) {
        const Light<Real>& light = scene.lights[shape.light];
        const Real cosine = lightCosine(light, surface.geometricNormal, surface.shadingNormal, vertex.wo);
        const Vec3<Real> emission = emissionAt(scene, light, surface.uv);
        if (cosine > 0) addEmission(scene, light, hit.primitive, emission, hit.t, cosine, state);
    }
    // Mitsuba's rule: the shading normal alone says which side is seen.
    if (!(glm::dot(surface.shadingNormal, vertex.wo) > 0)) {
        if ((shape.flags & shared::kShapeTwoSided) == 0) return false;
        surface.shadingNormal = -surface.shadingNormal;
    }
    ++path.counters[shared::kCounterVertices];
    return vertex.index < scene.constants.maxDepth && scatter(path, vertex, reflectance, state);
}

/// Scattering in a medium, at distance t of the path's ray.
///
/// @return whether the path goes on.
template <typename Real, typename Trace>
bool mediumVertex(const PathContext<Real, Trace>& path, const Medium<Real>& medium, Real t, Vertex<Real>& vertex,
                  PathState<Real>& state) {
    ++path.counters[shared::kCounterVertices];
    if (vertex.index >= path.scene.constants.maxDepth) return false;
    vertex.medium = &medium;
    vertex.position = state.ray.origin + t * state.ray.direction;
    const glm::uvec4 words = draw(path.stream.key, vertex.index, shared::kDrawAlbedo);
    const Vec3<Real> u{toUniform<Real>(words.x), toUniform<Real>(words.y), toUniform<Real>(words.z)};
    vertex.choice = words.w;
    return scatter(path, vertex, albedoAt(medium, vertex.position, u), state);
}

/// What happens where a flight ends.
///
/// @return whether the path goes on.
template <typename Real, typename Trace>
bool handleEvent(const PathContext<Real, Trace>& path, const FlightEnd<Real>& end, PathState<Real>& state) {
    using Kind = typename FlightEnd<Real>::Kind;
    if (end.kind == Kind::Truncated) {
        ++path.counters[shared::kCounterLoopTruncated];
        return false;
    }
    if (end.kind == Kind::Escape) {
        path.trace.add(PathEvent::Escape, 0);
        addEnvironment(path.scene, state);
        return false;
    }
    Vertex<Real> vertex;
    vertex.wo = -state.ray.direction;
    vertex.inside = state.ray.inside;
    vertex.index = state.scatterings + 1;
    return end.kind == Kind::Surface ? surfaceVertex(path, end.hit, vertex, state)
                                     : mediumVertex(path, *end.medium, end.t, vertex, state);
}

}  // namespace parhelion::reference
