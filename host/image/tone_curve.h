#pragma once

#include <glm/glm.hpp>

namespace parhelion {

/// Maps linear Rec. 709 radiance (1 = display white before compression) to linear display values in [0, 1].
///
/// With p the largest channel: the colour is left alone up to p = 1/2; above, it is scaled so that p becomes
/// 1 - 1/(4p) (same slope at 1/2, approaches 1), then mixed towards white by the brightness lost. Scaling and mixing
/// with grey keep the hue. Negative channels show as 0, any infinite channel as white, any NaN as magenta.
///
/// Source: the construction of the Khronos PBR Neutral tone mapper, with its toe removed and the shoulder at 1/2.
glm::dvec3 displayColour(const glm::dvec3& radiance);

/// Linear value in [0, 1] to its sRGB code value in [0, 1] (IEC 61966-2-1).
double encodeSrgb(double linear);

}  // namespace parhelion
