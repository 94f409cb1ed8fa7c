#pragma once

#include <span>
#include <vector>

#include "compile/compiled_scene.h"
#include "compile/placed_shape.h"

namespace parhelion {

/// The texture of a surface's reflectance or radiance: the record, or the one colour that it is.
struct SurfaceTexture {
    std::uint32_t index = shared::kNone;
    glm::dvec3 tint{1.0};     ///< factor of the untextured value
    glm::dvec3 mean{0.0};     ///< colour, averaged over the texture; of no meaning without one
    glm::dvec3 largest{1.0};  ///< of each channel, of what the tint multiplies
};

/// A shape that made it into the compiled scene.
struct KeptShape {
    const PlacedShape* placed = nullptr;
    std::uint32_t interior = shared::kNone;  ///< medium record
    std::uint32_t exterior = shared::kNone;  ///< shape index
    SurfaceTexture reflectance, radiance;

    bool isTextured() const { return reflectance.index != shared::kNone || radiance.index != shared::kNone; }
};

/// Where the geometry of an emissive shape went; one for each kept shape.
struct EmissiveGeometry {
    std::uint32_t primitive = shared::kNone;  ///< quad or sphere
    std::vector<std::uint32_t> triangles;     ///< meshes and tessellated shapes: primitive ids
};

/// Every ray tests every quad and box; beyond this many, the rest become triangles under the BVH.
inline constexpr std::size_t kMaxFlatPrimitives = 24;

/// Writes shapes (all but `light`), quads, spheres, boxes, and triangles under a BVH;
/// (u, v) of the triangles if any shape is textured.
///
/// Triangles of zero area are dropped with a note. Media boundaries and lights are the last to be tessellated.
/// @param scene  receives the arrays and notes.
/// @return parallel to `shapes`.
/// @throws InputError for more than kMaxSpheres spheres, and for what float cannot hold.
std::vector<EmissiveGeometry> compileGeometry(std::span<const KeptShape> shapes, CompiledScene& scene);

}  // namespace parhelion
