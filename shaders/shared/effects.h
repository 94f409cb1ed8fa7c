// The effects a scene can call for: derived by analyseEffects, never chosen by a user.
//
// X(identifier, specialisation constant id, label). A boolean constant each; `false` removes the
// code. Pruning is exact: with its own effects and with all of them on, a scene's film is the same
// to the bit.
#ifndef PARHELION_SHARED_EFFECTS_H
#define PARHELION_SHARED_EFFECTS_H

#define PARHELION_EFFECTS(X)                                                    \
    X(hasSurfaces, 0, "scattering surfaces")                                    \
    X(hasQuads, 1, "parallelograms")                                            \
    X(hasSpheres, 2, "spheres")                                                 \
    X(hasBoxes, 3, "boxes")                                                     \
    X(hasTriangles, 4, "triangle meshes (BVH)")                                 \
    X(hasMedia, 5, "participating media")                                       \
    X(hasManyMedia, 6, "more than one medium")                                  \
    X(hasHomogeneousMedia, 7, "homogeneous media (analytic transmittance)")     \
    X(hasHeterogeneousMedia, 8, "density grids (null-collision tracking)")      \
    X(hasChromaticExtinction, 9, "chromatic extinction (spectral MIS)")         \
    X(hasAlbedoGrids, 10, "albedo grids")                                       \
    X(hasHenyeyGreenstein, 11, "Henyey-Greenstein phase functions")             \
    X(hasBrickedDensity, 12, "sparse (bricked) density grids")                  \
    X(hasEnvironment, 13, "environment light")                                  \
    X(hasEnvironmentSampling, 14, "environment sampled by next-event estimation") \
    X(hasDeltaLights, 15, "directional and point lights")                       \
    X(hasAreaLights, 16, "area lights")                                         \
    X(hasManyLights, 17, "more than one sampled or area light")                     \
    X(hasDepthLimit, 18, "path depth limit")                                    \
    X(hasDoubleSided, 19, "two-sided surfaces")                                 \
    X(hasVertexNormals, 20, "interpolated vertex normals")                      \
    X(hasFilterTable, 21, "non-box reconstruction filter")                      \
    X(hasNestedMedia, 22, "media within media")                                 \
    X(hasTextures, 23, "textured surfaces")                                     \
    X(hasTexturedLights, 24, "textured area lights")                            \
    X(hasEnvironmentMap, 25, "environment map")                                 \
    X(hasSky, 26, "gradient sky")                                               \
    X(hasStars, 27, "stars")                                                    \
    X(hasDualHenyeyGreenstein, 28, "dual Henyey-Greenstein phase functions")    \
    X(hasRayleigh, 29, "Rayleigh phase functions")                              \
    X(hasTabulatedPhase, 30, "tabulated phase functions")                       \
    X(hasColorDensity, 31, "density grids with a value a channel")              \
    X(hasStrategyWeights, 32, "light and scattering samples of unequal weight") \
    X(hasTwoSidedLights, 33, "two-sided area lights")                           \
    X(hasDepthLayers, 34, "film layers by number of scatterings")

#endif
