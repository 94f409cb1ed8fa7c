#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "analysis/error_monitor.h"
#include "app/options.h"
#include "compile/render_settings.h"

namespace parhelion::app {

enum class Backend { Vulkan, Reference, ReferenceDouble };

/// The word that chooses a back end.
const char* nameOf(Backend backend);

/// parhelion render: what the user asked for. Options left out are empty.
struct RenderArguments {
    SceneArguments scene;
    std::string output;
    std::optional<std::int64_t> sampleCount, maxDepth, depthLayers;
    std::optional<double> error;    ///< to be reached, a share of 1
    std::optional<double> seconds;  ///< of the whole process
    ErrorNorm errorNorm = ErrorNorm::Rms;
    std::optional<double> saveSeconds;  ///< between files that are written on the way
    std::string report;                 ///< .html or .json, or empty
    std::optional<PixelRect> crop;
    std::optional<std::int64_t> seed;
    std::uint32_t featureSamples = 16;
    Backend backend = Backend::Vulkan;
    bool sampleEveryLight = false;
    Quality quality;
    std::optional<bool> sobol;
    // Those that only the Vulkan back end has.
    std::string device;
    std::optional<unsigned> vectorBits;
    std::optional<bool> allEffects;
    std::optional<std::uint32_t> stepsPerEvent;

    double exposure = 0;
    bool allowAnomalies = false, bakeError = false, json = false, quiet = false;
};

Command addRenderCommand(CommandLine& program, RenderArguments& arguments);

/// Renders and writes an EXR and a PNG. Returns the exit code.
int runRenderCommand(const RenderArguments& arguments);

}  // namespace parhelion::app
