// Camera rays.
#ifndef INTEGRATOR_CAMERA_GLSL
#define INTEGRATOR_CAMERA_GLSL

#include "core/scene.glsl"

// One axis of the reconstruction filter, importance sampled from its tabulated inverse CDF [pixels].
float filterOffset(float u) {
    float x = u * 256.0;
    float base = min(floor(x), 255.0);
    float a = texelFetch(filterTexels, int(base)).x, b = texelFetch(filterTexels, int(base) + 1).x;
    return a + (x - base) * (b - a);
}

// Film position of a sample of `pixel`, in pixels from the film's top left.
vec2 filmPosition(uvec2 pixel, vec2 u) {
    vec2 position = vec2(pixel) + u;
    if (hasFilterTable) {
        vec2 filtered = vec2(pixel) + 0.5 + vec2(filterOffset(u.x), filterOffset(u.y));
        position = camera.filterRadius == 0.5 ? position : filtered;
    }
    return position;
}

vec3 cameraDirection(vec2 film) {
    return normalize(camera.forward + film.x * camera.dx + film.y * camera.dy);
}

#endif
