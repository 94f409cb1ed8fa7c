#pragma once

#include <string>

#include "compile/compiled_scene.h"

namespace parhelion::test {

/// Expects that further submissions of a render need no further memory once a few have run: no code at all, and no more
/// than 2 MiB in all, where a driver that compiles anew keeps 80 KiB of code and 1 MiB in all of each.
///
/// @param scene  for a film of one workgroup or so: it is submitted some fifty times.
void expectNoNewCode(const std::string& name, const CompiledScene& scene, const EffectSet& effects);

}  // namespace parhelion::test
