#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/film_error.h"
#include "compile/compiled_scene.h"
#include "compile/render_settings.h"

namespace parhelion::test {

/// How often 95 % intervals held in independent renders of one scene.
struct Coverage {
    std::size_t renders = 0, image = 0;           ///< renders whose interval of the image's mean luminance holds
    std::size_t trusted = 0, trustedCovered = 0;  ///< pixels, over all renders
    std::size_t others = 0, othersCovered = 0;    ///< pixels whose interval is not to be trusted, and not dark
    std::size_t dark = 0;
    std::size_t errorTrusted = 0;  ///< renders whose relative root mean square error lies within its interval
    double samples = 0;            ///< mean over renders, of a pixel
    double meanZ = 0;              ///< of the image's mean: (estimate - truth) in standard errors over the renders

    double ofImage() const { return double(image) / double(renders); }
    double ofTrusted() const { return double(trustedCovered) / double(trusted); }
    double ofOthers() const { return double(othersCovered) / double(others); }
    /// "image 95.2 %, trusted pixels (87 %) 95.0 %, others (11 %) 71 %, ..."
    std::string text() const;
};

/// Judges renders by `truth`, the luminance of each pixel [units of the film].
/// @param render  gives the film of a seed.
Coverage coverageOf(const std::function<Film(std::uint32_t seed)>& render, std::uint32_t firstSeed, std::size_t renders,
                    std::span<const double> truth);

/// Mean luminance of each pixel over renders.
std::vector<double> meanLuminance(const std::function<Film(std::uint32_t seed)>& render, std::uint32_t firstSeed,
                                  std::size_t renders);

/// Settings with control pixels, without features.
RenderSettings settingsWithControls(const CompiledScene& scene, std::uint64_t samples, std::uint32_t seed, bool sobol);

}  // namespace parhelion::test
