#include "compile/transforms.h"

#include <fmt/format.h>

#include <cmath>

namespace parhelion {

namespace {

bool isFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool isFinite(const glm::vec3& v) { return isFinite(glm::dvec3(v)); }

/// Volume of the images of the unit axes, relative to a box with edges of the same lengths: 1 for orthogonal axes.
double relativeVolume(const glm::dmat3& m) {
    const double lengths = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
    return lengths > 0.0 ? std::abs(glm::determinant(m)) / lengths : 0.0;
}

}  // namespace

glm::dmat4 relativeTo(const glm::dmat4& toWorld, const glm::dvec3& origin) {
    glm::dmat4 result = toWorld;
    result[3] -= glm::dvec4(origin, 0.0) * toWorld[3].w;
    return result;
}

void requireInvertible(const glm::dmat4& matrix, const SourceLocation& where, const std::string& subject) {
    for (int column = 0; column < 4; ++column)
        if (!isFinite(glm::dvec3(matrix[column])) || matrix[column].w != (column == 3 ? 1.0 : 0.0))
            throw InputError(where, subject + ": to_world must be finite and affine (last row 0 0 0 1)");
    // Axes closer to a plane than this leave fewer than 4 digits of the inverse in double.
    constexpr double kSmallestRelativeVolume = 1e-12;
    const double volume = relativeVolume(glm::dmat3(matrix));
    if (!(volume > kSmallestRelativeVolume))
        throw InputError(where, fmt::format("{}: to_world must be invertible (no axis scaled to zero, no two axes "
                                            "parallel); got determinant {}",
                                            subject, glm::determinant(glm::dmat3(matrix))));
}

glm::vec3 toFloat(const glm::dvec3& value, const SourceLocation& where, const std::string& subject) {
    const glm::vec3 result(value);
    if (!isFinite(result))
        throw InputError(where, fmt::format("{} must be within the range of single precision (3.4e38); got {}, {}, {}",
                                            subject, value.x, value.y, value.z));
    return result;
}

glm::mat4x3 toFloat(const glm::dmat4& matrix, const SourceLocation& where, const std::string& subject) {
    glm::mat4x3 result;
    for (int column = 0; column < 4; ++column) result[column] = toFloat(glm::dvec3(matrix[column]), where, subject);
    return result;
}

}  // namespace parhelion
