#pragma once

#include <span>

#include "compile/compile_geometry.h"

namespace parhelion {

/// The power of two in whose multiples lights and film are kept, so that squares of samples stay within float.
///
/// 1 where the brightest light is between 2^-10 and 2^24; else the one that puts it into [1, 2). Light is linear, so
/// the image is the same to the bit for all units, but for what leaves the range of float. Lights are compared by
/// radiance; directional ones count by their irradiance, points by what arrives at the scene's radius, or up to
/// 2^40 times that if 1 will do then: near them things are brighter. 1 also where the brightest light is beyond float
/// altogether: what reads it says so.
double chooseRadianceUnit(const SceneDescription& description, std::span<const KeptShape> shapes, double sceneRadius);

/// An emitter with its radiance, irradiance or intensity in multiples of `unit`.
EmitterDescription inUnits(const EmitterDescription& emitter, double unit);

}  // namespace parhelion
