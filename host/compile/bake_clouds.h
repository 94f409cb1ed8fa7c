#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/scene_description.h"

namespace parhelion {

/// Who evaluates procedural clouds: a device, or its twin.
struct CloudBaker {
    /// The field at the centres of field.resolution voxels, x fastest. `base`: the density to modulate, as many voxels
    /// (empty without), `largest` its largest value.
    std::function<std::vector<float>(const shared::CloudField& field, std::span<const float> base, float largest)> bake;
    /// The field itself at p in the unit cube, where the density to modulate is `base`. Only errors need it.
    std::function<double(const shared::CloudField& field, const glm::dvec3& p, double base, float largest)> evaluate;
};

/// How far a baked grid, interpolated, is from the truth; in density.
struct CloudBakeError {
    double doubledRms = 0, doubledMaximum = 0;  ///< at the voxel centres of a bake of twice the resolution
    double fieldRms = 0, fieldMaximum = 0;      ///< at random points of the field that was not baked
    std::size_t points = 0;                     ///< of those
};

/// What the baking of one cloud took and gave.
struct CloudBakeReport {
    std::string where;  ///< file:line:column
    glm::uvec3 resolution{0};
    bool modulates = false;
    double seconds = 0;
    double meanDensity = 0;
    double occupancy = 0;  ///< fraction of the voxels that are not empty
    double massRatio = 1;  ///< modulates: mass after over before
    std::optional<CloudBakeError> error = std::nullopt;
};

struct CloudBakeOptions {
    std::size_t memoryLimitBytes = 0;  ///< 0: half of the machine's memory
    bool measureError = false;         ///< costs nine times the bake
};

/// Bakes every procedural cloud of the description into the grid that compileScene takes. Notes each that reaches
/// the sides of its box, where it is cut flat.
///
/// A field that modulates keeps the support of its density (less what densityThreshold empties), its largest value and,
/// within 1e-6, its mass: what erosion takes is given back to all voxels by one factor, up to the largest value.
/// @throws InputError for a cloud that needs more memory than allowed.
std::vector<CloudBakeReport> bakeClouds(SceneDescription& description, const CloudBaker& baker,
                                        const CloudBakeOptions& options = {});

/// Multiplies all values by one factor, up to `largest`, so that their sum becomes `mass` if it can.
/// @return the factor, and the sum that the values then have before they are rounded.
std::pair<double, double> restoreMass(std::span<float> values, double mass, float largest);

}  // namespace parhelion
