#pragma once

#include "reference/integrator/path_tracer.h"

namespace parhelion::reference {

/// Adds what the first opaque surface along a camera ray looks like; null boundaries and media are passed through.
template <typename Real>
void addFeature(const SceneView<Real>& scene, std::uint32_t seed, glm::uvec2 pixel, std::uint64_t sample,
                shared::FeaturePixel& sums) {
    const glm::uvec2 key = keyPath(scene, seed, pixel, sample).key;
    Ray<Real> ray = generateRay(scene, pixel, draw(key, 0, shared::kDrawFeature));
    Hit<Real> hit = closestHit(scene, ray);
    while (hit.found() && hit.isNull && crossBoundary(scene, hit, ray)) hit = closestHit(scene, ray);
    if (!hit.found() || hit.isNull) return;
    const shared::Shape& shape = scene.shapeAt(hit.shape);
    const Surface<Real> surface = surfaceAt(scene, ray, hit);
    sums.albedo += glm::vec3(reflectanceAt(scene.source, shape, surface.uv));
    sums.depth += float(hit.t);
    sums.normal += glm::vec3(surface.shadingNormal);
    sums.hits += 1.0f;
}

}  // namespace parhelion::reference
