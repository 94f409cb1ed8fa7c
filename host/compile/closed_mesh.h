#pragma once

#include <string>
#include <vector>

#include "compile/placed_shape.h"

namespace parhelion {

/// Makes sure that a mesh around a medium closes, and that all of its triangles face outwards.
///
/// Vertices at the same place are one, whatever their normals. Where edges are left with one triangle, their ends are
/// moved together if they are within 2^-18 of the largest coordinate (a unit of the sixth digit, in which files are
/// written) and 2^-10 of the mesh's size, and an edge may be closed by several shorter ones along it. Triangles wound
/// against their neighbours, and parts of the mesh that are inside out, are turned. Sets `triangles`, `parts` and
/// `volume` of `placed`, and moves `vertices`.
///
/// @return notes on what was mended.
/// @throws InputError where the mesh is not closed, for surfaces with one side only, and for a mesh that is inside out
///         as a whole; with counts and the place of one fault.
std::vector<std::string> closeMesh(PlacedShape& placed);

/// Checks that the parts of such a mesh do not overlap: that just within each triangle is inside once.
///
/// @return a note if a part overlaps itself.
/// @throws InputError if two parts overlap, with a place.
std::vector<std::string> checkInterior(const PlacedShape& placed);

}  // namespace parhelion
