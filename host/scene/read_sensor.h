#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// How a field of view was given.
enum class FovAxis { X, Y, Diagonal, Smaller, Larger };

/// Horizontal field of view of an image of the given aspect (width / height), from one along another axis. Degrees.
double horizontalFov(double fovDegrees, FovAxis axis, double aspect);

/// Diagonal field of view of a lens on 36 mm x 24 mm film. Degrees from millimetres.
double diagonalFovOfLens(double focalLength);

/// Reads <sensor>: fills the scene's camera, film, sample count and seed.
void readSensor(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
