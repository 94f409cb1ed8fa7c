#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Diagonal field of view of a lens on 36 mm x 24 mm film. Degrees from millimetres.
double diagonalFovOfLens(double focalLength);

inline constexpr NumberRange kFovRange{0.0, 180.0, true, true, "be in (0, 180) degrees"};
inline constexpr std::int64_t kMostSamples = std::int64_t{1} << 40;  ///< per pixel

/// A camera's placement from the transform property `name`; identity without one.
/// @throws InputError if it scales or shears.
glm::dmat4 readCameraTransform(PropertyReader& reader, const char* name);

/// Accepts the distances of a camera's clipping planes, which have no effect.
void readClipping(ReadContext& context, PropertyReader& reader, const char* nearName, const char* farName);

/// Reads <sensor>: fills the scene's camera, film, sample count and seed.
void readSensor(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
