#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/error_report.h"
#include "app/render_backends.h"
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
    std::uint64_t samples = 0;                           ///< per pixel, taken; the least of all
    double samplesPerPixel = 0;                          ///< the mean of them
    EndedBy endedBy = EndedBy::Samples;
    std::uint64_t samplesWanted = 0;
    std::uint32_t seed = 0;
    double prepareSeconds = 0;  ///< building pipelines, uploading
    double seconds = 0;         ///< rendering
    ErrorReport error;
    EffectSet effects;
    Quality quality;
    std::array<std::uint64_t, shared::kCounterCount> counters{};
    RangeFaults range;  ///< values that the image cannot hold
    std::vector<CloudBakeReport> clouds;
    std::vector<std::string> notes;

    bool interrupted() const { return endedBy == EndedBy::Interruption && samples < samplesWanted; }
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
/// One file of HTML about the error, without scripts and outside requests.
std::string errorPage(const RenderReport& report);
/// Writes the error as a page (.html) or as data (.json).
/// @throws InputError if the file cannot be created, RuntimeFailure if writing fails.
void writeErrorReport(const RenderReport& report, const std::filesystem::path& file);

}  // namespace parhelion::app
