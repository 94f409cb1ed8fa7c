#pragma once

#include "compile/placed_shape.h"

namespace parhelion {

/// Strictly inside: a point on the surface is outside. Meshes: ray parity, the majority of three directions.
bool containsPoint(const PlacedShape& shape, const glm::dvec3& point);

/// The insides do not meet. Exact for spheres and boxes, where touching within 1e-6 of their size is apart; with a
/// mesh, a true answer is certain (bounding boxes) and a false one is not: BoundaryRelations looks closer.
bool areApart(const PlacedShape& a, const PlacedShape& b);

/// `inner` lies within `outer`, touching allowed. Exact when `outer` is a sphere or a box; when it is a mesh, a false
/// answer is certain (bounding boxes) and a true one is not.
bool encloses(const PlacedShape& outer, const PlacedShape& inner);

}  // namespace parhelion
