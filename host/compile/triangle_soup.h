#pragma once

#include <cstdint>
#include <vector>

#include "compile/bvh_builder.h"
#include "compile/placed_shape.h"

namespace parhelion {

using TriangleUvs = std::array<glm::vec2, 3>;

/// Triangles of all shapes, in float, before the BVH orders them.
struct TriangleSoup {
    std::vector<TriangleVertices> vertices;
    std::vector<TriangleVertices> normals;  ///< unit shading normals; all zero: flat
    std::vector<TriangleUvs> uvs;           ///< without coordinates in a mesh: (0, 0), (1, 0), (0, 1), as Mitsuba
    std::vector<std::uint32_t> shapes;      ///< shape index of each
    std::size_t droppedCount = 0;           ///< triangles of zero area
    bool hasNormals = false;

    /// Adds a mesh, or a rectangle or cube cut into triangles. flip_normals turns the winding and the normals.
    /// Rectangles and cubes keep their side under a mirroring transform, a mesh turns over unless it has vertex normals
    /// of its own: Mitsuba's rules.
    /// @throws InputError for vertices outside the range of float.
    void add(const PlacedShape& shape, std::uint32_t shapeIndex);

private:
    void addTriangle(TriangleVertices triangle, TriangleVertices shading, TriangleUvs uv, std::uint32_t shapeIndex);
    void addMesh(const PlacedShape& shape, std::uint32_t shapeIndex);
    void addFlat(const PlacedShape& shape, std::uint32_t shapeIndex);
};

/// In double, from the vertices as stored.
double areaOf(const TriangleVertices& triangle);

}  // namespace parhelion
