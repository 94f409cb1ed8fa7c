#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace parhelion {

/// The geometry lines of an OBJ file (v, vn, vt, f), known to be well formed.
struct ObjText {
    std::string geometry;
    std::vector<SourceLocation> faces;  ///< of each f line
};

/// Checks every geometry line of a Wavefront OBJ text: tinyobjloader would read damaged numbers as zeros. Groups,
/// materials, lines, points and curves are left out.
///
/// @param file  for messages.
/// @throws InputError at the first number that is missing, malformed or beyond float, at the first face with fewer
/// than three corners or an index out of range, and for a file without faces.
ObjText checkObjText(std::string_view text, const std::string& file);

}  // namespace parhelion
