#pragma once

#include <cstdint>

#include "compile/compiled_scene.h"

namespace parhelion {

/// What to render of a CompiledScene, on either back end.
struct RenderSettings {
    std::uint64_t firstSample = 0;  ///< index of the first sample (64 bit)
    std::uint64_t sampleCount = 16;
    std::uint32_t seed = 0;
    std::uint32_t featureSamples = 16;  ///< camera rays per pixel for albedo, normal, depth
    Quality quality;
    EffectSet effects;  ///< usually scene.effects, or EffectSet::all()
};

}  // namespace parhelion
