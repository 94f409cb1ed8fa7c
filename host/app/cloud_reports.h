#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "compile/bake_clouds.h"
#include "gpu/device.h"

namespace parhelion::app {

inline constexpr const char* kBakeErrorHelp =
    "measure how far baked procedural clouds are from their fields (takes ten times the bake)";

/// Bakes on a device, or with its twin, whose grids have the same bits.
CloudBaker deviceBaker(gpu::Device& device);
CloudBaker twinBaker();

nlohmann::ordered_json toJson(std::span<const CloudBakeReport> reports);
/// A line or two for each cloud.
std::string describe(std::span<const CloudBakeReport> reports);

}  // namespace parhelion::app
