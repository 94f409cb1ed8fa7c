#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compile/placed_shape.h"

namespace parhelion {

/// Ends a heterogeneous medium of constant extinction where Mitsuba ends it: at the world-aligned bounds of its volume.
///
/// @param boundaries  the shapes that hold the medium.
/// @param worldOrigin of the shapes' scene space.
/// @param notes  gets a line where something is cut off, and one for a grid that Mitsuba would continue beyond its box.
/// @return the medium as a grid of one voxel over those bounds; none if all its boundaries lie within them, touching
///         allowed: then nothing is cut off, and the medium stays homogeneous.
/// @throws InputError for a volume whose to_world cannot be inverted.
std::optional<MediumDescription> clipToExtent(const MediumDescription& medium,
                                              std::span<const PlacedShape* const> boundaries,
                                              const glm::dvec3& worldOrigin, std::vector<std::string>& notes);

}  // namespace parhelion
