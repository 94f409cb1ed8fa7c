#pragma once

#include <filesystem>

#include "scene/scene_description.h"

namespace parhelion {

struct ObjOptions {
    bool faceNormals = false;   ///< leave the mesh without vertex normals
    bool smooth = true;         ///< compute vertex normals where the file has none, as Mitsuba does
    bool flipTexCoords = true;  ///< v becomes 1 - v, as Mitsuba has it
    /// Smooth normals are computed in the space this leads to (angles change under uneven scale), as Mitsuba does,
    /// and brought back by its transpose: a normal transforms by the inverse transpose.
    glm::dmat4 toWorld{1.0};
};

/// Reads the triangles of a Wavefront OBJ file. Polygons become fans about their first corner; corners with the same
/// position, texture coordinate and normal share a vertex. Without normals in the file the mesh gets smooth ones,
/// if options.smooth and not options.faceNormals. Degenerate triangles are kept. Texture coordinates are kept if every
/// corner has one.
///
/// @param where  blamed when the file cannot be read; what is wrong inside it is located there.
/// @throws InputError for malformed lines (checkObjText), polygons that a fan does not cover, normals given for some
/// corners only, normals of length zero, and vertices whose smooth normal is undefined.
Mesh readObjMesh(const std::filesystem::path& file, const SourceLocation& where, const ObjOptions& options);

}  // namespace parhelion
