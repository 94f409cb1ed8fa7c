#pragma once

#include "compile/compiled_scene.h"
#include "scene/scene_description.h"

namespace parhelion {

/// Whether an environment map has the same colour everywhere.
bool isUniform(const Bitmap& map);

/// Writes EnvironmentMap, its texels and all that sampling needs.
///
/// Cells between texels are chosen in proportion to their solid angle times the root mean square of the filtered
/// luminance in them, which is at least a third of its largest value; a cell that shines at all has a density above 0.
/// Maps of one or two rows become two or three, the last repeated, as in Mitsuba.
/// @param compensate  MIS compensation (Karlik et al. 2019): only what a cell has above the mean counts, unless no cell
///                    has. Unbiased only where scattering finds the rest.
/// @return mean radiance over all directions; 0: black, and nothing was written.
/// @throws InputError if the scaled map does not fit single precision, or has too many texels.
glm::dvec3 compileEnvironment(const EmitterDescription& emitter, bool compensate, CompiledScene& scene);

}  // namespace parhelion
