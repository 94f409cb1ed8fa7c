#pragma once

#include <string>

#include "base/film.h"
#include "compile/compiled_scene.h"

namespace parhelion::test {

/// Expects that the scene's film is the same to the bit compiled for its own effects and for all of them, without
/// anomalies; names the effects that change it otherwise. Prints the device time of both.
void expectExactPruning(const std::string& name, const CompiledScene& scene);

/// The film compiled for `effects`, 4 samples a pixel.
Film renderWithEffects(const CompiledScene& scene, const EffectSet& effects);

}  // namespace parhelion::test
