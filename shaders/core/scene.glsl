// The scene as the kernels see it: one uniform block for what is small, texel buffers for the rest.
#ifndef CORE_SCENE_GLSL
#define CORE_SCENE_GLSL

#include "core/effects.glsl"
#include "shared/path_types.h"
#include "shared/scene_types.h"

layout(set = 0, binding = 0, scalar) uniform SceneBlock { SceneConstants scene; };
layout(set = 0, binding = 1) uniform samplerBuffer shapeTexels;         // 2 a shape
layout(set = 0, binding = 2) uniform samplerBuffer bvhTexels;           // kBvhNodeTexels a node
layout(set = 0, binding = 3) uniform samplerBuffer triangleTexels;      // kTriangleTexels a triangle
layout(set = 0, binding = 4) uniform samplerBuffer vertexNormalTexels;  // 3 a triangle
layout(set = 0, binding = 5) uniform samplerBuffer densityTexels;
layout(set = 0, binding = 6) uniform usamplerBuffer brickTexels;
layout(set = 0, binding = 7) uniform samplerBuffer majorantTexels;
layout(set = 0, binding = 8) uniform samplerBuffer albedoTexels;
layout(set = 0, binding = 9) uniform samplerBuffer lightCdfTexels;
layout(set = 0, binding = 10) uniform usamplerBuffer lightTriangleTexels;
layout(set = 0, binding = 11) uniform samplerBuffer filterTexels;

// Up to this many shapes sit in the uniform block and are picked by comparison: cheaper than a gather.
const bool hasFewShapes = shapeCount <= kMaxInlineShapes;

// `reserved` is not read.
Shape shapeAt(uint index) {
    if (hasFewShapes) {
        Shape shape = scene.shapes[0];
        for (uint i = 1u; i < shapeCount; ++i)
            if (index == i) shape = scene.shapes[i];
        return shape;
    }
    vec4 a = texelFetch(shapeTexels, int(2u * index));
    uvec4 b = floatBitsToUint(texelFetch(shapeTexels, int(2u * index + 1u)));
    return Shape(a.xyz, floatBitsToUint(a.w), b.x, b.y, b.z, 0u);
}

// Medium inside shape `index`, or kNone.
uint interiorOf(uint index) {
    if (index == kNone) return kNone;
    return shapeAt(index).interior;
}

#endif
