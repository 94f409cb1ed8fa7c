#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "base/film.h"
#include "compile/compile_scene.h"
#include "compile/render_settings.h"
#include "image/image.h"
#include "support/hand_scene.h"

namespace parhelion::test {

/// Which renderer a statistical test looks at.
enum class Backend { Vulkan, Reference };
inline constexpr Backend kBackends[] = {Backend::Vulkan, Backend::Reference};
const char* name(Backend backend);
inline void PrintTo(Backend backend, std::ostream* stream) { *stream << name(backend); }

/// Renders with the scene's own effects and without the feature pass, on the device of testDevice() or in float.
/// @param sobol  stratified samples; otherwise independent ones, whose spread is the error of their mean.
Film renderOn(Backend backend, const CompiledScene& scene, std::uint64_t samples, std::uint32_t seed = 0,
              bool sobol = false);

/// Mean over pixels and samples with the standard error that the spread of the samples gives; all samples of a film
/// are independent with a box filter. For films whose pixels share one expectation.
PixelEstimate imageMean(const Film& film, int channel = 0);

/// Samples that were not finite or negative, densities above their bound, traversals and loops cut short.
std::uint64_t countAnomalies(const Film& film);

/// Images of independent seeds: firstSeed, firstSeed + 1, ...
std::vector<Image> renderSeeds(Backend backend, const CompiledScene& scene, std::uint64_t samples, std::size_t seeds,
                               std::uint32_t firstSeed, bool sobol = true);

}  // namespace parhelion::test
