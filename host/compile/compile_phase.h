#pragma once

#include <string>

#include "compile/compiled_scene.h"
#include "scene/scene_description.h"

namespace parhelion {

/// Writes the phase function of one medium, in the simplest form that says the same: a dual lobe of weight 0 or 1 or of
/// equal g is single, g = 0 and a constant table are isotropic. A table goes to scene.phaseTable as
/// shaders/README.md says ("Phase functions").
///
/// @param subject  the medium, for messages.
/// @throws InputError for tables of fewer than two values or more than 65536, with a negative or non-finite value, or
///         of zeros only.
void compilePhase(const PhaseDescription& phase, const std::string& subject, shared::Medium& record,
                  CompiledScene& scene);

}  // namespace parhelion
