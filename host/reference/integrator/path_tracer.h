#pragma once

#include "reference/integrator/camera.h"
#include "reference/integrator/vertex.h"

namespace parhelion::reference {

/// Follows the path's ray through media and null boundaries to its next real event.
/// Reference only: a loop over segments; the shader takes one at a time.
template <typename Real, typename Trace>
FlightEnd<Real> fly(const PathContext<Real, Trace>& path, PathState<Real>& state) {
    using Kind = typename FlightEnd<Real>::Kind;
    Ray<Real>& ray = state.ray;
    for (;;) {
        const Hit<Real> hit = closestHit(path.scene, ray);
        if (!hit.found()) {
            // A ray inside something always leaves it: it has left a mesh unnoticed.
            if (ray.inside == kNone) return {Kind::Escape};
            ray.inside = kNone;
            continue;
        }
        noticeEntry(path.scene, hit, ray);
        if (const Medium<Real>* medium = path.scene.interiorOf(ray.inside)) {
            const auto t = trackFlight(path, *medium, ray, hit.t, state.scatterings, state.residual, state.throughput);
            if (t) return {Kind::Medium, hit, medium, *t};
        }
        if (hit.near && !hit.isNull && leavesAside(path.scene, ray, hit)) {
            passHit(path.scene, hit, ray);
            continue;
        }
        path.trace.add(hit.isNull ? PathEvent::Boundary : PathEvent::Surface, hit.primitive);
        if (!hit.isNull) return {Kind::Surface, hit};
        if (!crossBoundary(path.scene, hit, ray)) return {Kind::Truncated};
    }
}

/// What the draws of one sample of one pixel are keyed by.
template <typename Real>
Stream keyPath(const SceneView<Real>& scene, std::uint32_t seed, glm::uvec2 pixel, std::uint64_t sample) {
    const std::uint32_t index = pixel.y * scene.source.filmSize.x + pixel.x;
    return streamOf(index, std::uint32_t(sample), std::uint32_t(sample >> 32), seed);
}

/// A path at the camera.
///
/// @param words  the camera draw.
template <typename Real>
PathState<Real> startPath(const SceneView<Real>& scene, glm::uvec2 pixel, const glm::uvec4& words) {
    PathState<Real> state;
    state.ray = generateRay(scene, pixel, words);
    state.residual = {exponential<Real>(words.z, spareBits(words.x, words.y, words.w))};
    return state;
}

/// Radiance along one camera path, which is added to the pixel's layers, if there are any.
/// Reference only: a loop over vertices; the shader's kernel runs one loop over all that can happen.
template <typename Real, typename Trace>
Vec3<Real> tracePath(const SceneView<Real>& scene, const Quality& quality, std::uint32_t seed, glm::uvec2 pixel,
                     std::uint64_t sample, Counters& counters, Trace& trace, shared::LayerPixel* layers = nullptr) {
    const Stream stream = keyPath(scene, seed, pixel, sample);
    const glm::uvec4 words = drawStratified(stream, quality.sobol, 0, shared::kDrawCamera);
    const int hero = std::min(int(3 * toUniform<Real>(words.w)), 2);
    const PathContext<Real, Trace> path{scene, quality, stream, hero, counters, trace};
    PathState<Real> state = startPath(scene, pixel, words);
    state.layers = layers;
    bool goesOn = scene.constants.maxDepth > 0;
    while (goesOn) goesOn = handleEvent(path, fly(path, state), state);
    ++counters[shared::kCounterPathsFinished];
    return state.radiance;
}

}  // namespace parhelion::reference
