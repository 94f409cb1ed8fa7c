#pragma once

#include <glm/glm.hpp>
#include <string>

#include "base/error.h"

namespace parhelion {

/// `toWorld` with its translation measured from `origin`. In double, before anything becomes float: at a distance of
/// 1e6 units floats are 0.06 apart.
glm::dmat4 relativeTo(const glm::dmat4& toWorld, const glm::dvec3& origin);

/// @throws InputError unless `matrix` is finite, affine (last row 0 0 0 1) and far from singular.
/// @param subject  what the message calls the owner of the matrix.
void requireInvertible(const glm::dmat4& matrix, const SourceLocation& where, const std::string& subject);

/// @throws InputError if a component is not finite as a float.
glm::vec3 toFloat(const glm::dvec3& value, const SourceLocation& where, const std::string& subject);
glm::mat4x3 toFloat(const glm::dmat4& matrix, const SourceLocation& where, const std::string& subject);

}  // namespace parhelion
