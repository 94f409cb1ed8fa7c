#pragma once

#include <span>
#include <vector>

#include "compile/compiled_scene.h"
#include "scene/scene_description.h"

namespace parhelion {

/// Which media of the description do nothing (no extinction, or no density anywhere), with a note for each.
std::vector<bool> findEmptyMedia(const SceneDescription& description, std::vector<std::string>& notes);

/// Writes media records, density, majorants and albedo voxels.
///
/// Grids with a value a channel are stored dense; all others alike, since the kernel reads one kind: dense, or bricked
/// if any one of them is large and mostly empty (more than 64 MiB dense with under 60 % of its bricks occupied), or if
/// they need more than kMaxTexels voxels together.
/// @param media       in the order of the records to write; none of them empty.
/// @param worldOrigin subtracted from every placement.
/// @param memoryLimitBytes  for the arrays written here.
/// @throws InputError for more than kMaxMedia media, singular placements, albedos outside [0, 1], and grids beyond the
///         limits (kMaxTexels voxels of density, and of albedo), naming the largest.
void compileMedia(std::span<const MediumDescription* const> media, const glm::dvec3& worldOrigin,
                  std::size_t memoryLimitBytes, CompiledScene& scene);

}  // namespace parhelion
