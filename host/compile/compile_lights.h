#pragma once

#include <span>
#include <vector>

#include "compile/compile_geometry.h"

namespace parhelion {

/// Writes the lights, in multiples of the radianceUnit that it chooses, their selection probabilities, and Shape.light.
/// Lights that are sampled come first; within both groups area lights in shape order, then emitters.
///
/// A light is selected with probability 0.5 / n + 0.5 * its share of the power of all n sampled lights, in multiples of
/// 2^-24: exactly what comparing a 24-bit uniform with `cumulative` gives. A mesh's triangles by area, each by at least
/// one word. Black lights are dropped with a note.
/// A constant environment, and a sky whose mean square luminance is at most twice its squared mean, are sampled only if
/// `sampleEveryLight` or if scattering takes no samples; a sphere that emits inwards never is. If light sampling takes
/// no samples, no light is sampled, and delta lights are dropped with a note.
/// @throws InputError for more than one emitter around the scene or more than kMaxLights lights.
void compileLights(const SceneDescription& description, std::span<const KeptShape> shapes,
                   std::span<const EmissiveGeometry> geometry, bool sampleEveryLight, CompiledScene& scene);

/// `selection`, `cumulative` and `reciprocal` from the power of each light (0: never sampled). Exposed for tests.
void assignSelection(std::span<const double> powers, std::span<shared::Light> lights);

}  // namespace parhelion
