// Canonical scene records: written by compileScene, read by the kernels and by the reference.
//
// World space here has its origin at the camera (compileScene translates in double precision), so
// distant scenes keep their float resolution where the picture is. Lengths are scene units.
//
// Primitive numbering: quads [0, Q), spheres [Q, Q+S), boxes [Q+S, Q+S+B), triangles after them.
#ifndef PARHELION_SHARED_SCENE_TYPES_H
#define PARHELION_SHARED_SCENE_TYPES_H

#include "language.h"

SHARED_BEGIN

SHARED_CONST(uint, kMaxQuads, 64u);
SHARED_CONST(uint, kMaxSpheres, 256u);
SHARED_CONST(uint, kMaxBoxes, 64u);
SHARED_CONST(uint, kMaxMedia, 16u);
SHARED_CONST(uint, kMaxLights, 256u);
SHARED_CONST(uint, kMaxInlineShapes, 8u);

SHARED_CONST(uint, kNone, 0xffffffffu);  // "no shape / medium / light / primitive"

// Bits of Shape.flags.
SHARED_CONST(uint, kShapeNull, 1u);        // null BSDF: a medium boundary, or nothing at all
SHARED_CONST(uint, kShapeTwoSided, 2u);    // diffuse on both sides
SHARED_CONST(uint, kShapeFlipNormal, 4u);  // spheres and boxes that face inwards; others have their side in the data
// On the device, boundaries are numbered so that those within one follow it: from these bits on, its own number and the
// last one within it (0, 0 for all other shapes).
SHARED_CONST(uint, kShapeOrderShift, 4u);
SHARED_CONST(uint, kShapeLastShift, 18u);
SHARED_CONST(uint, kMaxBoundaries, 16383u);  // medium boundaries of a scene

// Boundaries of one shape, met the wrong way round within this share of their distance, lie in one another (README,
// "inside").
SHARED_CONST(float, kCoincidence, 0.00006103515625f);

// What a primitive belongs to. Stored as two texels (vec4 each); integers bit-cast into floats.
struct Shape {
    vec3 reflectance;  // diffuse albedo, each channel in [0, 1]
    uint flags;        // kShape*
    uint interior;     // medium behind the surface (against the normal), or kNone
    uint exterior;     // shape whose interior surrounds this one, or kNone (vacuum): see "inside" in README
    uint light;        // index into lights, or kNone
    uint texture;      // index into the textures, which `reflectance` then tints, or kNone
};
SHARED_LAYOUT(Shape, 32);

// Bits of Texture.flags. A checkerboard reads no texels.
SHARED_CONST(uint, kTextureCheckerboard, 1u);
SHARED_CONST(uint, kTextureNearest, 2u);  // otherwise bilinear between texel centres
SHARED_CONST(uint, kTextureClamp, 4u);    // wrap mode; neither bit: repeat
SHARED_CONST(uint, kTextureMirror, 8u);

// A colour over the (u, v) of a surface, as six texels. Bitmap: texel (i, j), row j = 0 at v = 0, is
// textureTexels[offset + j * size.x + i].
struct Texture {
    vec2 transformU;  // (u', v') = transformU * u + transformV * v + translation
    vec2 transformV;
    vec2 translation;
    uint flags;  // kTexture*
    uint offset;
    uvec2 size;  // texels
    uint reserved0;
    uint reserved1;
    vec3 color0;  // checkerboard: where both or neither of fract(u'), fract(v') are below 1/2
    uint reserved2;
    vec3 color1;  // checkerboard: elsewhere
    uint reserved3;
    vec4 reserved4;
};
SHARED_LAYOUT(Texture, 96);

// Parallelogram corner + u * edgeU + v * edgeV, u and v in [0, 1].
struct Quad {
    vec3 corner;
    uint shape;
    vec3 edgeU;
    float area;  // |edgeU x edgeV|
    vec3 edgeV;
    float reserved;
    vec3 normal;  // unit, of the front side
    float reserved2;
    vec3 uFromWorld;  // u = dot(uFromWorld, p - corner)
    float reserved3;
    vec3 vFromWorld;  // v = dot(vFromWorld, p - corner)
    float reserved4;
};
SHARED_LAYOUT(Quad, 96);

struct Sphere {
    vec3 center;
    float radius;
    uint shape;
    uint flags;  // the shape's
    uint reserved1;
    uint reserved2;
    vec3 axisX;  // world directions of the sphere's own x and z axes, unit: for (u, v)
    uint reserved3;
    vec3 axisZ;
    float handedness;  // +1, or -1 under a mirroring transform: its y axis is handedness * cross(axisZ, axisX)
};
SHARED_LAYOUT(Sphere, 64);

// The image of [-1, 1]^3 under an affine map.
struct Box {
    mat4x3 localFromWorld;  // columns: x, y, z axes and translation
    uint shape;
    uint flags;  // the shape's
    uint reserved1;
    uint reserved2;
};
SHARED_LAYOUT(Box, 64);

SHARED_CONST(uint, kPhaseIsotropic, 0u);
SHARED_CONST(uint, kPhaseHenyeyGreenstein, 1u);
SHARED_CONST(uint, kPhaseDualHenyeyGreenstein, 2u);  // lobeWeight * HG(g) + (1 - lobeWeight) * HG(g2)
SHARED_CONST(uint, kPhaseRayleigh, 3u);
SHARED_CONST(uint, kPhaseTabulated, 4u);  // piecewise linear in mu

// Bits of Medium.flags.
SHARED_CONST(uint, kMediumHomogeneous, 1u);
SHARED_CONST(uint, kMediumAlbedoGrid, 2u);
SHARED_CONST(uint, kMediumBricked, 4u);
SHARED_CONST(uint, kMediumColorDensity, 8u);  // three values a voxel, interleaved: density of each channel

// Extinction of channel c at p is sigmaMax * sigmaRatio[c] * density(p).
struct Medium {
    mat4x3 gridFromWorld;    // world -> voxel units: the grid spans [0, resolution]
    vec3 sigmaRatio;         // per-channel extinction / sigmaMax, in [0, 1], largest exactly 1
    float sigmaMax;          // [1 / scene unit] at density 1
    vec3 albedo;             // single-scattering albedo, each channel in [0, 1]
    float g;                 // mean cosine of Henyey-Greenstein, |g| <= 1 - 2^-20
    uvec3 resolution;        // density voxels per axis
    uint voxelOffset;        // first voxel in `density` (dense), or first entry in `brickTable`
    uvec3 cells;             // majorant cells per axis: ceil(resolution / (kVoxelsPerCell << cellLevel))
    uint cellOffset;         // first cell in `majorants`
    mat4x3 albedoFromWorld;  // world -> voxel units of the albedo grid
    uvec3 albedoResolution;
    uint albedoOffset;  // first texel (rgba) in `albedoVoxels`
    uint phase;         // kPhase*
    uint flags;         // kMedium*
    float g2;           // dual: mean cosine of the second lobe
    float lobeWeight;   // dual: probability of the first lobe, a multiple of 2^-24 in (0, 1)
    uint phaseOffset;   // tabulated: first entry in `phaseTable`
    uint phaseCount;    // tabulated: intervals of mu
    uint cellLevel;     // majorant cells span kVoxelsPerCell << cellLevel voxels an axis
    uint phaseDistribution;  // tabulated: first texel of its intervals in `distributions`
};
SHARED_LAYOUT(Medium, 208);

SHARED_CONST(uint, kVoxelsPerCell, 8u);  // bricks, and the smallest majorant cells, are 8^3 voxels
SHARED_CONST(uint, kEmptyBrick, 0xffffffffu);

SHARED_CONST(uint, kLightDirectional, 0u);
SHARED_CONST(uint, kLightPoint, 1u);
SHARED_CONST(uint, kLightQuad, 2u);
SHARED_CONST(uint, kLightSphere, 3u);
SHARED_CONST(uint, kLightMesh, 4u);
SHARED_CONST(uint, kLightEnvironment, 5u);  // constant
SHARED_CONST(uint, kLightEnvironmentMap, 6u);
SHARED_CONST(uint, kLightSky, 7u);

// Largest squared sine of the half angle under which light sampling takes a sphere as seen from outside. Points on the
// sphere come out at 1, give or take their rounding; this leaves it 5e-5 radii.
SHARED_CONST(float, kFarthestCone, 0.9999f);

// Bits of Light.flags.
SHARED_CONST(uint, kLightTwoSided, 1u);  // an area light that emits on both sides

// Lights that next-event estimation samples come first.
struct Light {
    vec3 emission;     // irradiance (directional), intensity (point), radiance (others; the mean one of maps and skies)
    uint type;         // kLight*
    vec3 vector;       // directional: unit direction of travel; point: position
    uint primitive;    // quad, sphere: primitive id; mesh: first triangle id (global numbering)
    float selection;   // probability that next-event estimation selects this light, a multiple of 2^-24; 0: never sampled
    float cumulative;  // sum of `selection` over this and all earlier lights; exactly 1 from the last sampled one on
    uint reciprocal;   // of `selection`, for zoomWord: README, "Distributions"
    uint triangleCount;   // mesh: number of triangles
    uint triangleOffset;  // mesh: first of them in `lightTriangles`
    uint texture;        // area lights: index into the textures, which `emission` then tints, or kNone
    uint flags;          // kLightTwoSided
    uint distribution;   // mesh: first texel of its triangles in `distributions`
};
SHARED_LAYOUT(Light, 64);

// Pinhole: the camera looks along `forward`; film position (x, y) in pixels from the top left has
// direction normalize(forward + x * dx + y * dy), with forward pointing at the film's corner (0, 0).
struct Camera {
    vec3 forward;
    uint inside;  // shape whose interior holds the camera, or kNone
    vec3 dx;
    uint filterEdges;  // pixels that the filter reaches beyond its own, on each side
    vec3 dy;
    uint hasFilter;   // 0: the pixel's box
    uvec2 filmLower;  // film pixels [filmLower, filmUpper) that the filter may reach
    uvec2 filmUpper;
};
SHARED_LAYOUT(Camera, 64);
SHARED_CONST(uint, kFilterSteps, 256u);  // of the filter's inverse CDF, which filterEdges values of its CDF follow

// Latitude-longitude map, Mitsuba's `envmap`: in local space (+y up) u = atan2(x, -z) / 2 pi, columns centred on (i +
// 1/2) / width and periodic; v = acos(y) / pi, rows at j / (height - 1), so that the first and the last row are the
// poles.
struct EnvironmentMap {
    vec3 localX;  // rows of the rotation world -> local
    uint width;   // texels
    vec3 localY;
    uint height;
    vec3 localZ;
    uint distribution;  // first texel of its rows in `distributions`; the rows' cells follow
};
SHARED_LAYOUT(EnvironmentMap, 48);

SHARED_CONST(uint, kMaxStars, 262144u);
SHARED_CONST(uint, kMaxStarsPerCell, 8u);

// Gradient sky with stars: t = clamp((t_raw + offset - 1/2) / width + 1/2, 0, 1)^power, t_raw = (dot(d, axis) + 1) / 2,
// L = (1 - t) bottom + t top.
struct Sky {
    vec3 axis;  // unit
    float offset;
    vec3 bottom;  // radiance
    float width;  // 0: a step
    vec3 top;
    float power;
    vec3 starRadiance;    // of a star of brightness 1
    uint starCells;       // per edge of a face of the lookup cube; 0: no stars
    uint starCount;
    uint bandCount;     // bands of equal height in dot(d, axis) that sampling chooses from
    uint distribution;  // first texel of bands and stars in `distributions`
    uint reserved;
};
SHARED_LAYOUT(Sky, 80);

// The uniform block: everything small.
struct SceneConstants {
    Camera camera;
    uint quadCount;
    uint sphereCount;
    uint boxCount;
    uint triangleCount;
    uint mediumCount;
    uint lightCount;
    uint environment;          // light index of the environment, or kNone
    uint maxDepth;             // Mitsuba's max_depth; 0xffffffff: unlimited
    uint rouletteDepth;        // Mitsuba's rr_depth
    vec3 environmentRadiance;  // of lights[environment], where that is constant; 0 otherwise
    float emitterSamples;      // direct lighting: samples of lights and of scattering that the weights assume;
    float scatterSamples;      // the larger is 1
    uint reserved;
    uint depthLayers;  // film layers by number of scatterings, the last for all above; 0: none
    EnvironmentMap environmentMap;
    Sky sky;
    Quad quads[kMaxQuads];
    Sphere spheres[kMaxSpheres];
    Box boxes[kMaxBoxes];
    Medium media[kMaxMedia];
    Light lights[kMaxLights];
    Shape shapes[kMaxInlineShapes];  // the first of the shapes, a copy
};
SHARED_LAYOUT(SceneConstants, 64 + 64 + 48 + 80 + 64 * 96 + 256 * 64 + 64 * 64 + 16 * 208 + 256 * 64 + 8 * 32);

// BVH: four texels per inner node: (min0, child0) (max0, 0) (min1, child1) (max1, 0), children
// bit-cast ints. child >= 0: inner node; child < 0: leaf ~((firstTriangle << 3) | count), count in
// 1..kMaxLeafTriangles, firstTriangle local to the triangle list. Node 0 is the root.
SHARED_CONST(uint, kBvhNodeTexels, 4u);
SHARED_CONST(uint, kMaxLeafTriangles, 4u);
SHARED_CONST(uint, kBvhStackSize, 48u);  // the builder refuses deeper trees
SHARED_CONST(int, kBvhEnd, 0x7fffffff);
// Triangles: three texels, xyz vertex; w of the first: shape index bit-cast.
SHARED_CONST(uint, kTriangleTexels, 3u);
// Vertex normals: three texels a triangle; all zero where the triangle is flat.
// Texture coordinates: three pairs a triangle, (u, v) of its vertices.

SHARED_END

#endif
