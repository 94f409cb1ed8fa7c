// What sampling a light gives.
#ifndef LIGHT_LIGHT_SAMPLE_GLSL
#define LIGHT_LIGHT_SAMPLE_GLSL

struct LightSample {
    vec3 direction;         // unit, towards the light
    float distance;         // to the light point; infinite for directional and environment
    vec3 radianceOverPdf;   // 0 where the light cannot be seen
    float pdf;              // per steradian, selection included; infinite for delta lights
    uint target;            // primitive to ignore on the way
};

#endif
