#include "app/scene_inventory.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace parhelion::app {

namespace {

LightEntry describeLight(const CompiledScene& scene, const shared::Light& light) {
    static constexpr const char* kTypes[] = {"directional", "point",       "parallelogram",   "sphere",
                                             "mesh",        "environment", "environment map", "sky"};
    return {kTypes[light.type], glm::vec3(scene.radianceUnit * glm::dvec3(light.emission)), light.selection,
            light.type == shared::kLightMesh ? light.triangleCount : 0};
}

/// Fraction of a grid's majorant cells whose bound is above zero.
double occupancyOf(const CompiledScene& scene, const shared::Medium& medium) {
    const std::size_t count = std::size_t{medium.cells.x} * medium.cells.y * medium.cells.z;
    const auto bounds = std::span(scene.majorants).subspan(medium.cellOffset, count);
    const auto occupied = std::count_if(bounds.begin(), bounds.end(), [](float bound) { return bound > 0; });
    return count > 0 ? static_cast<double>(occupied) / static_cast<double>(count) : 0;
}

std::string describePhase(const shared::Medium& medium) {
    switch (medium.phase) {
        case shared::kPhaseHenyeyGreenstein:
            return fmt::format("Henyey-Greenstein, g = {}", medium.g);
        case shared::kPhaseDualHenyeyGreenstein:
            return fmt::format("dual Henyey-Greenstein, g = {} (weight {:.6g}) and {}", medium.g, medium.lobeWeight,
                               medium.g2);
        case shared::kPhaseRayleigh:
            return "Rayleigh";
        case shared::kPhaseTabulated:
            return fmt::format("table of {} values", medium.phaseCount + 1);
        default:
            return "isotropic";
    }
}

MediumEntry describeMedium(const CompiledScene& scene, const shared::Medium& medium) {
    const bool homogeneous = (medium.flags & shared::kMediumHomogeneous) != 0;
    MediumEntry entry{.type = homogeneous ? "homogeneous" : "grid",
                      .phase = describePhase(medium),
                      .extinction = medium.sigmaMax * medium.sigmaRatio,
                      .albedo = medium.albedo};
    if (!homogeneous) {
        entry.resolution = medium.resolution;
        entry.bricked = (medium.flags & shared::kMediumBricked) != 0;
        entry.occupancy = occupancyOf(scene, medium);
    }
    if ((medium.flags & shared::kMediumAlbedoGrid) != 0) entry.albedoResolution = medium.albedoResolution;
    return entry;
}

}  // namespace

SceneInventory takeInventory(const CompiledScene& scene) {
    const shared::SceneConstants& constants = scene.constants;
    SceneInventory inventory;
    inventory.filmSize = scene.filmSize;
    inventory.cropOffset = scene.cropOffset;
    inventory.cropSize = scene.cropSize;
    inventory.sampleCount = scene.sampleCount;
    inventory.shapes = scene.shapes.size();
    inventory.quads = constants.quadCount;
    inventory.spheres = constants.sphereCount;
    inventory.boxes = constants.boxCount;
    inventory.triangles = constants.triangleCount;
    inventory.arrays = scene.arraySizes();
    inventory.memoryBytes = scene.memoryBytes();
    inventory.effects = scene.effects;
    inventory.notes = scene.notes;
    inventory.boundaries = static_cast<std::size_t>(
        std::count_if(scene.shapes.begin(), scene.shapes.end(),
                      [](const shared::Shape& shape) { return (shape.flags & shared::kShapeNull) != 0; }));
    for (const shared::Light& light : std::span(constants.lights, constants.lightCount))
        inventory.lights.push_back(describeLight(scene, light));
    for (const shared::Medium& medium : std::span(constants.media, constants.mediumCount))
        inventory.media.push_back(describeMedium(scene, medium));
    return inventory;
}

}  // namespace parhelion::app
