// The scene as the kernels see it: one uniform block for what is small, texel buffers for the rest.
#ifndef CORE_SCENE_GLSL
#define CORE_SCENE_GLSL

#include "core/effects.glsl"
#include "core/unroll.glsl"
#include "shared/path_types.h"
#include "shared/scene_types.h"

layout(set = 0, binding = 0, scalar) uniform SceneBlock { SceneConstants scenes[1]; };
layout(set = 0, binding = 1) uniform samplerBuffer shapeTexels;         // 2 a shape
layout(set = 0, binding = 2) uniform samplerBuffer bvhTexels;           // kBvhNodeTexels a node
layout(set = 0, binding = 3) uniform samplerBuffer triangleTexels;      // kTriangleTexels a triangle
layout(set = 0, binding = 4) uniform samplerBuffer vertexNormalTexels;  // 3 a triangle
layout(set = 0, binding = 5) uniform samplerBuffer densityTexels;
layout(set = 0, binding = 6) uniform usamplerBuffer brickTexels;
layout(set = 0, binding = 7) uniform samplerBuffer majorantTexels;
layout(set = 0, binding = 8) uniform samplerBuffer albedoTexels;
layout(set = 0, binding = 9) uniform samplerBuffer triangleAreas;       // of mesh lights, see meshArea
layout(set = 0, binding = 10) uniform usamplerBuffer lightTriangleTexels;
layout(set = 0, binding = 11) uniform samplerBuffer filterTexels;
layout(set = 0, binding = 16) uniform samplerBuffer textureRecords;     // 6 a texture
layout(set = 0, binding = 17) uniform samplerBuffer textureTexels;      // rgb
layout(set = 0, binding = 18) uniform samplerBuffer triangleUvTexels;   // 3 a triangle
layout(set = 0, binding = 19) uniform samplerBuffer phaseTexels;
layout(set = 0, binding = 20) uniform samplerBuffer environmentTexels;  // rgb; w: density of the cell below right
layout(set = 0, binding = 21) uniform usamplerBuffer distributionTexels;
layout(set = 0, binding = 22) uniform samplerBuffer environmentRows;    // of each row of cells: see README, "Environment map"
layout(set = 0, binding = 23) uniform samplerBuffer skyBands;           // density of each band per steradian
layout(set = 0, binding = 24) uniform samplerBuffer starTexels;         // 2 a star
layout(set = 0, binding = 25) uniform usamplerBuffer starCells;
layout(set = 0, binding = 27) uniform usamplerBuffer sceneNumber;       // 0

// The scene's place in its block comes from a texel, so that no offset into the block is a constant. Where a branch
// depends on nothing but words at constant offsets of a uniform block or of push constants, Mesa 22's software driver
// takes their values for constants: it compiles the kernel again at every submission, and keeps what it compiled.
uint sceneIndex = texelFetch(sceneNumber, 0).x;
#define scene scenes[sceneIndex]

// Private copies of what the path loop reads all the time. A load from the uniform block is a gather on
// the software driver, whatever its offset, and none is moved out of a loop; these are registers.
Camera camera;
Quad nearQuads[kNearCount];
Sphere nearSpheres[kNearCount];
Box nearBoxes[kNearCount];
Shape nearShapes[kNearCount];
Medium nearMedium;
Light nearLight;
Quad nearLightQuad;      // of nearLight, where it is one
Sphere nearLightSphere;
vec3 environmentRadiance;
uint environmentLight;
EnvironmentMap environmentMap;
Sky sky;
uint maxDepth;
uint rouletteDepth;
uint triangleCount;
float emitterSamples;
float scatterSamples;
uint depthLayers;

// Shader only: fills the copies; every kernel calls it first.
void loadScene() {
#define LOAD_QUAD(i) nearQuads[i] = scene.quads[i];
#define LOAD_SPHERE(i) nearSpheres[i] = scene.spheres[i];
#define LOAD_BOX(i) nearBoxes[i] = scene.boxes[i];
#define LOAD_SHAPE(i) nearShapes[i] = scene.shapes[i];
    FOR_EACH_NEAR(quadCount, LOAD_QUAD)
    FOR_EACH_NEAR(sphereCount, LOAD_SPHERE)
    FOR_EACH_NEAR(boxCount, LOAD_BOX)
    FOR_EACH_NEAR(shapeCount, LOAD_SHAPE)
    camera = scene.camera;
    nearMedium = scene.media[0];
    nearLight = scene.lights[0];
    nearLightQuad = scene.quads[min(nearLight.primitive, kMaxQuads - 1u)];
    nearLightSphere = scene.spheres[min(nearLight.primitive - quadCount, kMaxSpheres - 1u)];
    environmentRadiance = scene.environmentRadiance;
    environmentLight = scene.environment;
    environmentMap = scene.environmentMap;
    sky = scene.sky;
    maxDepth = scene.maxDepth;
    rouletteDepth = scene.rouletteDepth;
    triangleCount = scene.triangleCount;
    emitterSamples = scene.emitterSamples;
    scatterSamples = scene.scatterSamples;
    depthLayers = scene.depthLayers;
}

Shape shapeAt(uint index) {
    if (shapeCount <= kNearCount) {
        Shape shape = nearShapes[0];
#define PICK_SHAPE(i) \
    if (index == i) shape = nearShapes[i];
        FOR_EACH_NEAR(shapeCount, PICK_SHAPE)
        return shape;
    }
    vec4 a = texelFetch(shapeTexels, int(2u * index));
    uvec4 b = floatBitsToUint(texelFetch(shapeTexels, int(2u * index + 1u)));
    return Shape(a.xyz, floatBitsToUint(a.w), b.x, b.y, b.z, b.w);
}

// Medium inside shape `index`, or kNone.
uint interiorOf(uint index) {
    if (index == kNone) return kNone;
    return shapeAt(index).interior;
}

#endif
