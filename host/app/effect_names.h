#pragma once

#include <array>
#include <string>

#include "compile/compiled_scene.h"

namespace parhelion::app {

struct EffectName {
    const char* identifier;  ///< as in the shaders: "hasMedia"
    const char* label;       ///< "participating media"
};

/// By effect number.
inline constexpr std::array<EffectName, kEffectCount> kEffectNames{{
#define X(name, id, label) {#name, label},
    PARHELION_EFFECTS(X)
#undef X
}};

/// The identifiers of the effects that are on, separated by spaces: names the pipeline that rendered a scene.
std::string effectsKey(const EffectSet& effects);
/// "stepsPerEvent=6 shadowRoulette=3 stochasticFilter=true"
std::string qualityKey(const Quality& quality);

}  // namespace parhelion::app
