// A lane a pixel: `sampleCount` camera rays of one pixel into the feature film.
// loopBudget: boundaries a ray may cross; not a constant, which would unroll the loop.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
layout(local_size_x = 64) in;

#include "integrator/features.glsl"

layout(set = 0, binding = 28, scalar) readonly buffer ArgumentBlock { PathArguments submitted; };
layout(set = 0, binding = 14, scalar) buffer CounterBlock { uint counters[]; };
layout(set = 0, binding = 15, scalar) buffer FeatureBlock { FeaturePixel features[]; };

PathArguments arguments = submitted;

void main() {
    loadScene();
    uint index = arguments.firstPixel + gl_GlobalInvocationID.x;
    if (gl_GlobalInvocationID.x >= arguments.laneCount) return;
    uvec2 pixel = arguments.cropOffset + uvec2(index % arguments.cropSize.x, index / arguments.cropSize.x);
    uint pixelIndex = pixel.y * arguments.filmSize.x + pixel.x;
    FeaturePixel sums = features[gl_GlobalInvocationID.x];
    bool ok = true;
    uint tests = 0u;
    for (uint i = 0u; i < arguments.sampleCount; ++i) {
        uvec2 key = pathKey(pixelIndex, arguments.sampleLow + i, arguments.sampleHigh, arguments.seed);
        uvec4 word = draw(key, 0u, kDrawFeature);
        ok = addFeature(sums, pixel, vec2(toUniform(word.x), toUniform(word.y)), tests, arguments.loopBudget) && ok;
    }
    features[gl_GlobalInvocationID.x] = sums;
    if (!ok) atomicAdd(counters[kCounterBvhOverflow], 1u);
}
