#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace parhelion {

using TriangleVertices = std::array<glm::vec3, 3>;

/// A bounding volume hierarchy in the encoding of scene_types.h.
struct Bvh {
    std::vector<glm::vec4> nodes;      ///< kBvhNodeTexels a node, node 0 the root; empty without triangles
    std::vector<std::uint32_t> order;  ///< order[i]: which given triangle comes i-th in the leaves
    unsigned depth = 0;                ///< inner nodes on the longest way down
};

/// Longest way down that the builder allows: what a traversal stack of kBvhStackSize holds, with room to spare.
inline constexpr unsigned kMaxBvhDepth = 46;

/// Builds a hierarchy by the surface area heuristic over bins, falling back to halves where the heuristic would grow
/// deeper than kMaxBvhDepth or cannot tell the triangles apart.
///
/// Every box encloses its triangles with a margin of 8 roundings (2^-24) of the largest coordinate, so that a traversal
/// in float misses nothing. Deterministic. Vertices must be finite; at most 2^28 triangles.
///
/// Source: Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies".
Bvh buildBvh(std::span<const TriangleVertices> triangles);

}  // namespace parhelion
