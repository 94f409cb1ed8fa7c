// Auxiliary film layers: albedo, normal and depth of the first opaque surface along the camera ray.
#ifndef INTEGRATOR_FEATURES_GLSL
#define INTEGRATOR_FEATURES_GLSL

#include "core/scene.glsl"
#include "geometry/intersection.glsl"
#include "integrator/camera.glsl"
#include "sampling/sampler.glsl"
#include "surface/texture.glsl"

// Adds one camera ray. Boundaries crossed are bounded by `crossings`; false when it or a traversal cut
// the ray short.
bool addFeature(inout FeaturePixel pixel, uvec2 film, vec2 u, inout uint tests, uint crossings) {
    Ray ray = newRay(vec3(0.0), cameraDirection(filmPosition(film, u)), kInfinity, kNone, kNone, camera.inside, -1.0);
    bool ok = true, crossing = true;
    for (uint i = 0u; i < crossings && crossing; ++i) {
        Hit hit = closestHit(ray, true, tests, ok);
        crossing = false;
        if (hit.primitive != kNone) {
            Surface surface = surfaceAt(ray, hit);
            Shape shape = shapeAt(surface.shape);
            crossing = (shape.flags & kShapeNull) != 0u;
            if (crossing) {
                crossBoundary(ray, hit, surface.shape, shape.exterior, surface.geometricNormal);
            } else {
                pixel.albedo += reflectanceAt(shape, surface.uv);
                pixel.normal += surface.shadingNormal;
                pixel.depth += hit.t;
                pixel.hits += 1.0;
            }
        }
    }
    return ok && !crossing;
}

#endif
