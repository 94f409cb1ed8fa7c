#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"

namespace parhelion::app {

struct LightEntry {
    std::string type;
    glm::vec3 emission;     ///< irradiance (directional), intensity (point) or radiance
    double selection;       ///< probability that next-event estimation picks it; 0: met by scattering only
    std::size_t triangles;  ///< of a mesh light
};

struct MediumEntry {
    std::string type;      ///< "homogeneous" or "grid"
    std::string phase;     ///< "isotropic", "Henyey-Greenstein, g = ...", ...
    glm::vec3 extinction;  ///< at density 1 [1/scene unit]
    glm::vec3 albedo;
    glm::uvec3 resolution{0};  ///< voxels; 0 without a grid
    bool bricked = false;
    double occupancy = 0;  ///< fraction of the majorant cells that hold any density
    glm::uvec3 albedoResolution{0};
};

/// What a compiled scene holds, counted.
struct SceneInventory {
    glm::uvec2 filmSize{0}, cropOffset{0}, cropSize{0};
    std::uint64_t sampleCount = 0;
    std::size_t shapes = 0, boundaries = 0;  ///< boundaries: shapes of null material, counted in shapes too
    std::size_t quads = 0, spheres = 0, boxes = 0, triangles = 0;
    std::vector<LightEntry> lights;
    std::vector<MediumEntry> media;
    std::vector<ArraySize> arrays;
    std::size_t memoryBytes = 0;
    EffectSet effects;
    std::vector<std::string> notes;
};

SceneInventory takeInventory(const CompiledScene& scene);
nlohmann::ordered_json toJson(const SceneInventory& inventory);
std::string describe(const SceneInventory& inventory);

}  // namespace parhelion::app
