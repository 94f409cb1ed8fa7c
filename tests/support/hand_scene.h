#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compile/compiled_scene.h"
#include "compile/render_settings.h"
#include "scene/scene_description.h"
#include "shared/path_types.h"

namespace parhelion::test {

/// A CompiledScene put together by hand, so that tests of a renderer do not depend on reader and compiler.
///
/// The camera is at the origin. Add primitives in the order quads, spheres, boxes, triangles: ids depend on it.
class HandScene {
public:
    HandScene();

    /// A film of one pixel whose rays all go along `direction`.
    void lookAlong(glm::vec3 direction, std::uint32_t inside = shared::kNone);
    /// A film of width x height pixels, 90 degrees wide, along `direction`.
    void lookAt(glm::vec3 direction, glm::uvec2 size);

    std::uint32_t addHomogeneous(float sigma, glm::vec3 albedo, float g = 0.0f, glm::vec3 sigmaRatio = glm::vec3(1));
    /// Density grid of the given resolution over the box [low, high]; majorants: the largest voxel times `slack`.
    std::uint32_t addGrid(float sigma, glm::vec3 albedo, glm::uvec3 resolution, std::span<const float> voxels,
                          glm::vec3 low, glm::vec3 high, float slack = 1.0f);
    shared::Medium& medium(std::uint32_t index) { return scene.constants.media[index]; }

    std::uint32_t addShape(const shared::Shape& shape);
    std::uint32_t addNull(std::uint32_t interior, std::uint32_t exterior = shared::kNone);
    std::uint32_t addDiffuse(glm::vec3 reflectance, std::uint32_t flags = 0);

    /// @return the primitive's id.
    std::uint32_t addQuad(glm::vec3 corner, glm::vec3 edgeU, glm::vec3 edgeV, std::uint32_t shape);
    std::uint32_t addSphere(glm::vec3 center, float radius, std::uint32_t shape);
    std::uint32_t addBox(glm::vec3 low, glm::vec3 high, std::uint32_t shape);
    /// All triangles at once: three vertices each, the same shape.
    void addTriangles(std::span<const glm::vec3> vertices, std::uint32_t shape);

    /// Makes `radiance` come from everywhere; selection 0: not sampled by next-event estimation.
    void setEnvironment(glm::vec3 radiance);
    /// Surrounds the scene with a sky, of which next-event estimation is a part unless told otherwise.
    void setSky(const SkyDescription& sky, bool isSampled = true);
    /// Surrounds the scene with an environment map that is neither black nor uniform.
    void setEnvironmentMap(const EmitterDescription& map, bool isSampled = true);
    /// Lights share the selection evenly unless `isSampled` is false.
    void addLight(shared::Light light, bool isSampled = true);
    /// Makes a quad or sphere emit.
    void addAreaLight(std::uint32_t type, std::uint32_t primitive, std::uint32_t shape, glm::vec3 radiance,
                      bool isSampled = true);
    void addMeshLight(std::uint32_t shape, glm::vec3 radiance, bool isSampled = true);

    CompiledScene scene;

private:
    std::vector<bool> sampled_;
};

/// A patch of floor that faces up, seen from above.
HandScene floorPatch(glm::vec3 reflectance = glm::vec3(0.5f), float distance = 1);

/// A box of fog, looked at askew; scattering is forward.
HandScene fogBox(glm::vec3 albedo = {0.9f, 0.8f, 0.7f});

/// Mean of a pixel's samples and the standard error of that mean, first channel unless told.
struct PixelEstimate {
    double mean, error;
};
PixelEstimate estimate(const shared::FilmPixel& pixel, std::uint64_t samples, int channel = 0);

/// Renders the scene in double, or in float, and gives pixel 0.
PixelEstimate renderPixel(const CompiledScene& scene, std::uint64_t samples, bool inDouble = false, int channel = 0);

/// A closed convex mesh about the origin: an icosphere of unit radius, three vertices a triangle.
std::vector<glm::vec3> icosphere(int subdivisions);

}  // namespace parhelion::test
