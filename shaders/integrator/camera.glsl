// Camera rays.
#ifndef INTEGRATOR_CAMERA_GLSL
#define INTEGRATOR_CAMERA_GLSL

#include "core/scene.glsl"

// One axis of the reconstruction filter, importance sampled from its tabulated inverse CDF [pixels].
float filterOffset(float u) {
    float x = u * float(kFilterSteps);
    float base = min(floor(x), float(kFilterSteps - 1u));
    float a = texelFetch(filterTexels, int(base)).x, b = texelFetch(filterTexels, int(base) + 1).x;
    return a + (x - base) * (b - a);
}

// Share of one axis of the filter that lies within `pixels` whole pixels beyond its own.
float filterShare(uint pixels) {
    return pixels < camera.filterEdges ? texelFetch(filterTexels, int(kFilterSteps + 1u + pixels)).x : 1.0;
}

// Film position of a sample of `pixel`, in pixels from the film's top left. The filter ends where the film does: `u` runs
// over what is left of it there.
vec2 filmPosition(uvec2 pixel, vec2 u) {
    vec2 position = vec2(pixel) + u;
    if (hasFilterTable) {
        uvec2 before = pixel - camera.filmLower, after = camera.filmUpper - 1u - pixel;
        vec2 low = 1.0 - vec2(filterShare(before.x), filterShare(before.y));
        vec2 high = vec2(filterShare(after.x), filterShare(after.y));
        vec2 inside = low + u * (high - low);
        vec2 filtered = vec2(pixel) + 0.5 + vec2(filterOffset(inside.x), filterOffset(inside.y));
        position = camera.hasFilter != 0u ? filtered : position;
    }
    return position;
}

vec3 cameraDirection(vec2 film) {
    return normalize(camera.forward + film.x * camera.dx + film.y * camera.dy);
}

#endif
