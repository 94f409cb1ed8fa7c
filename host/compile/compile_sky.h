#pragma once

#include "compile/compiled_scene.h"
#include "scene/scene_description.h"

namespace parhelion {

/// Bands of equal height that sampling chooses from; a power of two, so that their heights are exact.
inline constexpr std::uint32_t kSkyBands = 256;

/// Radiance of the gradient at t_raw = (cos + 1) / 2 in [0, 1].
glm::dvec3 skyGradientAt(const SkyDescription& sky, double tRaw);

/// Whether the sky has the same radiance everywhere: skyGradientAt(sky, any).
bool isUniform(const SkyDescription& sky);

/// Writes Sky, its stars, their lookup grid and all that sampling needs.
///
/// Two things that no float direction can show are rounded off: a width below 2^-60 becomes 0 (a step), a power above 0
/// but below 1e-30 becomes 1e-30.
/// @return mean radiance over all directions; 0: black, and nothing was written.
/// @throws InputError if a value does not fit single precision.
glm::dvec3 compileSky(const SkyDescription& sky, const SourceLocation& where, CompiledScene& scene);

/// Mean square of the compiled sky's luminance over the square of its mean, 1 for a uniform one; not below it. It is
/// the second moment of what scattering finds where it is isotropic and nothing is in the way.
double skyContrast(const SkyDescription& sky, const CompiledScene& scene);

}  // namespace parhelion
