#pragma once

#include <cstdint>

#include "compile/compiled_scene.h"
#include "compile/control_pixels.h"

namespace parhelion {

/// Samples per pixel of a render that something else ends; exact in float and far beyond what any has time for.
inline constexpr std::uint64_t kUnlimitedSamples = std::uint64_t{1} << 24;

/// What to render of a CompiledScene, on either back end.
struct RenderSettings {
    std::uint64_t firstSample = 0;  ///< index of the first sample (64 bit)
    std::uint64_t sampleCount = 16;
    std::uint32_t seed = 0;
    std::uint32_t featureSamples = 16;  ///< camera rays per pixel for albedo, normal, depth
    ControlPixels controls;             ///< none, unless the error is to be known
    Quality quality;
    EffectSet effects;  ///< usually scene.effects, or EffectSet::all()
};

}  // namespace parhelion
