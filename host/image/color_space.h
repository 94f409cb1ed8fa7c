#pragma once

#include <glm/glm.hpp>

#include "image/image.h"

namespace parhelion {

/// The primaries and the white, D65, of ITU-R BT.709.
inline constexpr Chromaticities kRec709{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};

/// Whether the primaries lie apart and off one line, and the white has a luminance: else rounding alone decides what
/// the matrices below hold.
bool spansColours(const Chromaticities& space);

/// Linear RGB of the given primaries to CIE XYZ; white has Y = 1.
glm::dmat3 xyzFromRgb(const Chromaticities& space);

/// Linear RGB of the given primaries to linear Rec. 709; nothing adapts to another white. The identity, exactly, for
/// what is Rec. 709 but for its rounding.
glm::dmat3 rec709FromRgb(const Chromaticities& space);

/// CIE XYZ to linear Rec. 709, with Mitsuba's coefficients. By columns.
inline constexpr glm::dmat3 kRec709FromXyz{3.240479,  -0.969256, 0.055648, -1.537150, 1.875991,
                                           -0.204043, -0.498535, 0.041556, 1.057311};

/// Linear RGB from OpenEXR's luminance and chroma: Y, RY = (R - Y) / Y, BY = (B - Y) / Y, luminance being that of
/// `space`.
glm::dvec3 rgbFromChroma(double y, double ry, double by, const Chromaticities& space);

}  // namespace parhelion
