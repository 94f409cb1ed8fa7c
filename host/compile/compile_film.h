#pragma once

#include <vector>

#include "compile/compile_scene.h"

namespace parhelion {

/// Fills filmSize, cropOffset and cropSize from the description and the overrides of `options`.
/// @throws InputError for an empty or too large film, and for a crop that leaves it.
void compileFilm(const SceneDescription& description, const CompileOptions& options, CompiledScene& scene);

/// Horizontal field of view of a film of the given aspect (width / height), from one along another axis. Degrees.
double horizontalFov(double fovDegrees, FovAxis axis, double aspect);

/// Fills constants.camera (all but `inside`), worldOrigin and the filter table. Needs the film size.
///
/// Mitsuba's perspective camera. A size override keeps the field of view along the axis that it was given for.
/// @throws InputError for a fov outside (0, 180) degrees or a camera transform with scale or shear.
void compileCamera(const SceneDescription& description, CompiledScene& scene);

/// Inverse cumulative distribution of a reconstruction filter on one axis: entry k is the offset in pixels below
/// which a share k / 256 of the filter's weight lies; 257 entries, antisymmetric about entry 128. Then, unless the
/// filter reaches beyond the film, the share that lies within 0, 1, ... whole pixels beyond the sampled one, as far as
/// it is below 1. Empty for the box of radius 0.5, which needs none.
///
/// Source: Mitsuba 3 `tent` (1 - |x| / radius) and `gaussian` (exp(-x^2 / 2 s^2) less its value at the radius).
std::vector<float> reconstructionTable(const FilmDescription& film);

}  // namespace parhelion
