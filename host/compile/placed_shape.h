#pragma once

#include <array>
#include <string>
#include <vector>

#include "scene/scene_description.h"

namespace parhelion {

/// A shape of the description in scene space (world space with its origin at the camera), in double.
struct PlacedShape {
    enum class Kind { Quad, Sphere, Box, Mesh };

    const ShapeDescription* source = nullptr;
    Kind kind = Kind::Mesh;
    glm::dmat4 toScene{1.0};            ///< local space -> scene space
    bool mirrored = false;              ///< toScene turns right-handed axes into left-handed ones
    glm::dvec3 center{0.0};             ///< Kind::Sphere
    double radius = 0.0;                ///< Kind::Sphere
    std::vector<glm::dvec3> vertices;   ///< quad: 4, box: 8 corners, (x, y, z) = bits 0, 1, 2; mesh: all; sphere: none
    glm::dvec3 lower{0.0}, upper{0.0};  ///< bounds
    double volume = 0.0;                ///< enclosed, > 0 for outward triangles; quad: 0
    std::vector<glm::uvec3> triangles;  ///< mesh: as wound in its file, or mended where it bounds a medium
    std::vector<std::uint32_t> parts;   ///< mesh around a medium: which of its closed parts each triangle belongs to
    std::vector<std::string> notes;     ///< what was mended

    bool isNull() const { return source->bsdf.type == BsdfDescription::Type::Null; }
    bool isAnalyticSolid() const { return kind == Kind::Sphere || kind == Kind::Box; }
    bool mentionsMedia() const { return source->interior || source->exterior; }
    bool isMediumMesh() const { return kind == Kind::Mesh && isNull() && mentionsMedia(); }
};

/// Corners of a box's faces, counterclockwise from outside; bits 0, 1, 2 of a corner are x, y, z.
inline constexpr unsigned kBoxFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                             {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

/// Corners of a triangle of a mesh in scene space, counterclockwise seen from its front.
std::array<glm::dvec3, 3> cornersOf(const PlacedShape& mesh, std::uint32_t triangle);

/// All triangles of a mesh like that, or of a box.
std::vector<std::array<glm::dvec3, 3>> surfaceOf(const PlacedShape& shape);

/// What messages call a shape: `sphere "id"`, or `sphere` where it has no id.
std::string nameOf(const ShapeDescription& shape);

/// Places a shape and checks that it can be simulated.
/// @throws InputError for singular transforms, spheres under a non-uniform scale, area lights on null surfaces, media
///         on shapes that enclose nothing, are not closed or inside out, and meshes with broken indices.
PlacedShape placeShape(const ShapeDescription& shape, const glm::dvec3& worldOrigin);

}  // namespace parhelion
