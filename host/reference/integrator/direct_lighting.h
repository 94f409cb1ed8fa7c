#pragma once

#include "reference/light/light.h"
#include "reference/sampling/mis.h"
#include "reference/surface/bsdf.h"
#include "reference/volume/phase_function.h"
#include "reference/volume/tracking.h"

namespace parhelion::reference {

/// Where light scatters: at a point of a medium, or of a surface.
template <typename Real>
struct Vertex {
    Vec3<Real> position;
    Vec3<Real> wo;                         ///< unit, to where the path came from
    const Medium<Real>* medium = nullptr;  ///< null on a surface
    Surface<Real> surface{};               ///< normals on the side of wo; of no meaning in a medium
    std::uint32_t primitive = kNone;
    std::uint32_t inside = kNone;
    std::uint32_t index = 0;   ///< scatterings so far, this one included
    std::uint32_t choice = 0;  ///< random word: lobe of a dual phase function, digits for a tabulated one
    Real strength = 1;         ///< largest channel of the reflectance; 1 in a medium
};

/// Scattering value without albedo or reflectance, cosine included; it is also the density that scattering samples.
template <typename Real>
Real evalScatterer(const Vertex<Real>& vertex, const Vec3<Real>& wi) {
    return vertex.medium ? evalPhase(*vertex.medium, vertex.wo, wi) : evalDiffuse(vertex.surface.shadingNormal, wi);
}

/// @param words  x and y of a scatter draw.
template <typename Real>
DirectionSample<Real> sampleScatterer(const Vertex<Real>& vertex, const glm::uvec2& words) {
    if (vertex.medium) return samplePhase(*vertex.medium, vertex.wo, words, vertex.choice);
    return sampleDiffuse(vertex.surface.shadingNormal, {toUniform<Real>(words.x), toUniform<Real>(words.y)});
}

/// Ray that leaves a vertex; off triangles by their rounding, to the side it goes to (H41).
/// Reference only: startRay writes it into the path state.
template <typename Real>
Ray<Real> spawnRay(const Vertex<Real>& vertex, const Vec3<Real>& direction) {
    Ray<Real> ray;
    ray.origin = vertex.position;
    ray.direction = direction;
    ray.last = vertex.primitive;
    ray.inside = vertex.inside;
    if (!vertex.medium) ray.start = vertex.surface.start();
    if (!vertex.medium && vertex.surface.rounding > 0) {
        const Vec3<Real>& n = vertex.surface.geometricNormal;
        ray.origin += n * std::copysign(vertex.surface.rounding, glm::dot(n, direction));
    }
    return ray;
}

/// Unbiased estimate of the transmittance to ray.tMax per channel; 0 behind an opaque surface.
/// Reference only: a loop over segments; the shader takes one at a time.
///
/// @param residual   of the shadow ray's first tentative collision.
/// @param threshold  see trackShadow.
template <typename Real, typename Trace>
Vec3<Real> estimateTransmittance(const PathContext<Real, Trace>& path, Ray<Real> ray, std::uint32_t vertex,
                                 Residual<Real> residual, Real threshold) {
    Vec3<Real> weight(1);
    for (;;) {
        const Hit<Real> hit = closestHit(path.scene, ray);
        const bool isOpaque = hit.found() && !hit.isNull;
        if (isOpaque && !hit.near) return Vec3<Real>(0);
        if (isOpaque && !leavesAside(path.scene, ray, hit)) return Vec3<Real>(0);
        const Real tEnd = hit.found() ? hit.t : ray.tMax;
        if (std::isinf(tEnd)) {
            // Without an end the ray is inside nothing, or has left a mesh unnoticed.
            if (ray.inside == kNone) return weight;
            ray.inside = kNone;
            continue;
        }
        noticeEntry(path.scene, hit, ray);
        const Medium<Real>* medium = path.scene.interiorOf(ray.inside);
        if (medium && !trackShadow(path, *medium, ray, tEnd, vertex, threshold, residual, weight)) return Vec3<Real>(0);
        if (!hit.found()) return weight;
        if (isOpaque)
            passHit(path.scene, hit, ray);
        else if (!crossBoundary(path.scene, hit, ray)) {
            ++path.counters[shared::kCounterLoopTruncated];
            return Vec3<Real>(0);
        }
    }
}

/// Next-event estimation: scattered radiance from one light, without albedo or reflectance.
template <typename Real, typename Trace>
Vec3<Real> estimateDirect(const PathContext<Real, Trace>& path, const Vertex<Real>& vertex) {
    const glm::uvec4 words = drawStratified(path.stream, path.quality.sobol, vertex.index, shared::kDrawLight);
    const auto light = sampleLight(path.scene, vertex.position, glm::uvec3(words));
    if (!light) return Vec3<Real>(0);
    const Real scattering = evalScatterer(vertex, light->direction);
    const shared::SceneConstants& constants = path.scene.constants;
    const Real mis = light->isDelta ? Real(1)
                                    : balanceHeuristic(light->pdf * Real(constants.emitterSamples),
                                                       scattering * Real(constants.scatterSamples));
    const Vec3<Real> contribution = scattering * mis * light->radianceOverPdf;
    if (maxComponent(contribution) == 0) return Vec3<Real>(0);
    Ray<Real> ray = spawnRay(vertex, light->direction);
    ray.tMax = light->distance;
    ray.target = light->target;
    const Residual<Real> residual{exponential<Real>(words.w, spareBits(words.x, words.y, words.z))};
    const Real value = 4 * kPi<Real> * scattering * vertex.strength;
    const Real threshold = std::min(Real(1), Real(path.quality.shadowRoulette) / value);
    const Vec3<Real> transmittance = estimateTransmittance(path, ray, vertex.index, residual, threshold);
    path.trace.add(PathEvent::ShadowEnd, maxComponent(transmittance) > 0);
    return contribution * transmittance;
}

}  // namespace parhelion::reference
