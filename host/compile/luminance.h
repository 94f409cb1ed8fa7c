#pragma once

#include <glm/glm.hpp>

namespace parhelion {

/// Rec. 709, as Mitsuba weighs it.
inline double luminance(const glm::dvec3& rgb) { return 0.212671 * rgb.r + 0.715160 * rgb.g + 0.072169 * rgb.b; }

}  // namespace parhelion
