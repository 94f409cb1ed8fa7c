#pragma once

#include "compile/triangle_tree.h"

namespace parhelion {

/// Whether two triangles pierce each other by more than `tolerance`: each has corners farther than that from the
/// other's plane on both of its sides, and they share more than that length of the line where the planes meet.
/// Triangles that touch, lie in one plane or have a corner or an edge in common and no more do not.
///
/// Source: Moller 1997, "A Fast Triangle-Triangle Intersection Test".
bool pierce(const Corners& a, const Corners& b, double tolerance);

/// A point that both of two such triangles hold.
glm::dvec3 piercedPoint(const Corners& a, const Corners& b);

/// Distance from `point` to the nearest point of a triangle.
double distanceTo(const Corners& triangle, const glm::dvec3& point);

/// Its front's unit normal; zero for a triangle without area.
glm::dvec3 unitNormal(const Corners& triangle);

}  // namespace parhelion
