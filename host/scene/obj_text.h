#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace parhelion {

/// The geometry of an OBJ file, known to be well formed.
struct ObjText {
    struct Place {
        int line, column;
    };

    std::string file;
    std::string geometry;            ///< the statements v, vn, vt and f, one a line, without comments
    std::vector<Place> faces;        ///< of each f
    std::vector<std::string> notes;  ///< located: what was left out

    SourceLocation whereOfFace(std::size_t face) const { return {file, faces[face].line, faces[face].column}; }
};

/// Checks every geometry statement of a Wavefront OBJ text: tinyobjloader would read damaged numbers as zeros, and
/// knows neither comments behind numbers nor lines that go on in the next one. Numbers too small for a float become
/// zero. Names, groups, materials and smoothing are left out; statements that hold geometry which is not read (lines,
/// points, curves) or that are unknown, colours and weights of vertices, and the second and further materials are
/// noted.
///
/// @param file  for messages.
/// @throws InputError for a file that is no text, at the first number that is missing, malformed or beyond float, at
/// the first face with fewer than three corners or an index out of range, and for a file without faces.
ObjText checkObjText(std::string_view text, const std::string& file);

}  // namespace parhelion
