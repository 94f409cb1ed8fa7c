#pragma once

#include "compile/render_settings.h"
#include "gpu/pipeline.h"

namespace parhelion::render {

/// The specialisation constants of shaders/core/effects.glsl: one a row of the effect, quality and size tables.
gpu::Specialisation specialise(const CompiledScene& scene, const EffectSet& effects, const Quality& quality);

}  // namespace parhelion::render
