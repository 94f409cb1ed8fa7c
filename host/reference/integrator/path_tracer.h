#pragma once

#include "reference/integrator/camera.h"
#include "reference/integrator/direct_lighting.h"

namespace parhelion::reference {

/// A path between two of its vertices.
template <typename Real>
struct PathState {
    Ray<Real> ray;
    Residual<Real> residual;
    Throughput<Real> throughput{};
    Vec3<Real> radiance{0};
    Real lastPdf = kInfinity<Real>;  ///< of the ray's direction; infinite from the camera: no light sample competes
    std::uint32_t scatterings = 0;
};

/// Where a path's flight ends.
template <typename Real>
struct FlightEnd {
    enum class Kind { Escape, Surface, Medium, Truncated } kind;
    Hit<Real> hit{};
    const Medium<Real>* medium = nullptr;
    Real t = 0;
};

/// Follows the path's ray through media and null boundaries to its next real event.
template <typename Real, typename Trace>
FlightEnd<Real> fly(const PathContext<Real, Trace>& path, PathState<Real>& state) {
    Ray<Real>& ray = state.ray;
    for (;;) {
        const Hit<Real> hit = closestHit(path.scene, ray);
        if (!hit.found()) {
            if (ray.inside == kNone) return {FlightEnd<Real>::Kind::Escape};
            ray.inside = kNone;
            continue;
        }
        if (const Medium<Real>* medium = path.scene.mediumInside(ray.inside)) {
            const auto t = trackFlight(path, *medium, ray, hit.t, state.scatterings, state.residual, state.throughput);
            if (t) return {FlightEnd<Real>::Kind::Medium, hit, medium, *t};
        }
        path.trace.add(hit.isNull ? PathEvent::Boundary : PathEvent::Surface, hit.primitive);
        if (!hit.isNull) return {FlightEnd<Real>::Kind::Surface, hit, nullptr, hit.t};
        if (!crossBoundary(path.scene, hit, ray)) return {FlightEnd<Real>::Kind::Truncated};
    }
}

/// Adds emission met at the end of a flight, weighted against light sampling at its start.
template <typename Real>
void addEmission(const SceneView<Real>& scene, std::uint32_t lightIndex, Real distance, const Vec3<Real>& normal,
                 PathState<Real>& state) {
    const Light<Real>& light = scene.lights[lightIndex];
    const Real pdf = lightPdf(scene, light, state.ray.origin, state.ray.direction, distance, normal);
    const Real mis = balanceHeuristic(state.lastPdf, pdf);
    state.radiance += state.throughput.beta * light.emission * (mis / state.throughput.meanR());
}

/// Vertex at a surface, with emission added.
///
/// @return false when the path ends there: a one-sided surface from behind.
template <typename Real>
bool enterSurface(const SceneView<Real>& scene, const Hit<Real>& hit, PathState<Real>& state, Vertex<Real>& vertex) {
    const shared::Shape& shape = scene.source.shapes[hit.shape];
    vertex.surface = surfaceAt(scene, state.ray, hit);
    vertex.position = vertex.surface.position;
    vertex.primitive = hit.primitive;
    const bool isFront = glm::dot(vertex.surface.geometricNormal, vertex.wo) > 0;
    if (isFront && shape.light != kNone)
        addEmission(scene, shape.light, hit.t, vertex.surface.geometricNormal, state);
    if (isFront) return true;
    vertex.surface.geometricNormal = -vertex.surface.geometricNormal;
    vertex.surface.shadingNormal = -vertex.surface.shadingNormal;
    return (shape.flags & shared::kShapeTwoSided) != 0;
}

/// Absorption, roulette, direct light and the next direction at a vertex.
///
/// @param albedo  albedo or reflectance.
/// @return whether the path goes on.
template <typename Real, typename Trace>
bool scatter(const PathContext<Real, Trace>& path, Vertex<Real>& vertex, const Vec3<Real>& albedo,
             PathState<Real>& state) {
    Throughput<Real>& throughput = state.throughput;
    throughput.beta *= albedo;
    const Real largest = maxComponent(throughput.beta);
    if (largest == 0) return false;
    const glm::uvec4 words = draw(path.key, vertex.index, shared::kDrawScatter);
    if (vertex.index >= path.scene.constants.rouletteDepth) {
        const Real survival = std::clamp(largest / throughput.meanR(), Real(0.05), Real(1));
        const Real u = toUniform<Real>(words.w);
        if constexpr (Trace::kIsOn)
            path.trace.add(
                Decision{Decision::Kind::PathRoulette, vertex.index, 0, 0, double(u), double(survival)});
        if (!(u < survival)) return false;
        throughput.beta /= survival;
    }
    state.radiance += throughput.beta * sampleDirect(path, vertex) / throughput.meanR();
    const Vec2<Real> u{toUniform<Real>(words.x), toUniform<Real>(words.y)};
    const DirectionSample<Real> next = sampleScattering(vertex, u);
    state.ray = spawnRay(vertex, next.direction);
    state.lastPdf = next.pdf;
    state.residual = {exponential<Real>(words.z, spareBits(words.x, words.y, words.w))};
    state.scatterings = vertex.index;
    return true;
}

/// One event of a path: emission, then scattering unless the path ends.
///
/// @return whether the path goes on.
template <typename Real, typename Trace>
bool handleEvent(const PathContext<Real, Trace>& path, const FlightEnd<Real>& end, PathState<Real>& state) {
    using Kind = typename FlightEnd<Real>::Kind;
    const SceneView<Real>& scene = path.scene;
    if (end.kind == Kind::Truncated) {
        ++path.counters[shared::kCounterLoopTruncated];
        return false;
    }
    if (end.kind == Kind::Escape) {
        path.trace.add(PathEvent::Escape, 0);
        if (scene.constants.environment != kNone)
            addEmission(scene, scene.constants.environment, kInfinity<Real>, -state.ray.direction, state);
        return false;
    }
    ++path.counters[shared::kCounterVertices];
    Vertex<Real> vertex;
    vertex.wo = -state.ray.direction;
    vertex.inside = state.ray.inside;
    vertex.index = state.scatterings + 1;
    Vec3<Real> albedo{0};
    if (end.kind == Kind::Surface) {
        if (!enterSurface(scene, end.hit, state, vertex)) return false;
        albedo = scene.source.shapes[end.hit.shape].reflectance;
        vertex.strength = maxComponent(albedo);
    } else {
        vertex.medium = end.medium;
        vertex.position = state.ray.origin + end.t * state.ray.direction;
    }
    if (vertex.index >= scene.constants.maxDepth) return false;
    if (end.kind == Kind::Medium) {
        const glm::uvec4 words = draw(path.key, vertex.index, shared::kDrawAlbedo);
        const Vec3<Real> u{toUniform<Real>(words.x), toUniform<Real>(words.y), toUniform<Real>(words.z)};
        albedo = albedoAt(*end.medium, vertex.position, u);
    }
    return scatter(path, vertex, albedo, state);
}

/// Radiance along one camera path.
template <typename Real, typename Trace>
Vec3<Real> tracePath(const SceneView<Real>& scene, const Quality& quality, std::uint32_t seed, glm::uvec2 pixel,
                     std::uint64_t sample, Counters& counters, Trace& trace) {
    const std::uint32_t index = pixel.y * scene.source.filmSize.x + pixel.x;
    const glm::uvec2 key = pathKey(index, std::uint32_t(sample), std::uint32_t(sample >> 32), seed);
    const glm::uvec4 words = draw(key, 0, shared::kDrawCamera);
    const int hero = std::min(int(3 * toUniform<Real>(words.w)), 2);
    const PathContext<Real, Trace> path{scene, quality, key, hero, counters, trace};
    PathState<Real> state{generateRay(scene, pixel, words),
                          {exponential<Real>(words.z, spareBits(words.x, words.y, words.w))}};
    if (scene.constants.maxDepth > 0)
        while (handleEvent(path, fly(path, state), state)) {
        }
    ++counters[shared::kCounterPathsFinished];
    return state.radiance;
}

}  // namespace parhelion::reference
