#pragma once

#include <optional>

#include "scene/scene_description.h"

namespace parhelion {

/// Unit normals at the vertices of a mesh: the mean of the adjacent triangles' normals, each weighted by its angle at
/// the vertex (Thurmer and Wuthrich 1998, "Computing Vertex Normals from Polygonal Facets"). A vertex that only
/// degenerate triangles use gets (0, 0, 1).
///
/// @param positions  of the mesh's vertices, in the space the normals are for.
/// @return nothing if the normals around some vertex cancel out; `undefinedVertex` is its index then.
std::optional<std::vector<glm::dvec3>> smoothNormals(const std::vector<glm::dvec3>& positions,
                                                     const std::vector<glm::uvec3>& triangles,
                                                     std::size_t& undefinedVertex);

}  // namespace parhelion
