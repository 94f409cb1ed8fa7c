#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compile/bake_clouds.h"
#include "compile/render_settings.h"
#include "image/film_image.h"
#include "shared/path_types.h"

namespace parhelion::app {

/// All that a render says about itself, in the image's attributes, as JSON and as text.
struct RenderReport {
    std::string scene, exr, png;  ///< paths
    std::string backend;          ///< "vulkan", "reference", "reference-double"
    std::string device, driver;
    glm::uvec2 filmSize{0}, cropOffset{0}, cropSize{0};  ///< pixels
    std::uint64_t samples = 0;                           ///< per pixel, taken
    std::uint64_t samplesWanted = 0;
    std::uint32_t seed = 0;
    double prepareSeconds = 0;            ///< building pipelines, uploading
    double seconds = 0;                   ///< rendering
    std::optional<double> relativeError;  ///< see estimateRelativeError
    EffectSet effects;
    Quality quality;
    std::array<std::uint64_t, shared::kCounterCount> counters{};
    RangeFaults range;  ///< values that the image cannot hold
    std::vector<CloudBakeReport> clouds;
    std::vector<std::string> notes;

    bool interrupted() const { return samples < samplesWanted; }
    double samplesPerSecond() const;
    /// Samples dropped as not finite, or taken with a majorant below the density, or values out of range: the image
    /// cannot be trusted.
    bool hasAnomalies() const;
};

/// Adds attributes named "parhelion.*", and pbrt's samplesPerPixel and renderTimeSeconds.
void addAttributes(const RenderReport& report, Image& image);
nlohmann::ordered_json toJson(const RenderReport& report);
/// A few lines for a person; counters only where they are not zero.
std::string describe(const RenderReport& report);

}  // namespace parhelion::app
