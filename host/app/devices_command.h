#pragma once

#include <CLI/CLI.hpp>

namespace parhelion::app {

struct DevicesArguments {
    bool json = false;
};

CLI::App* addDevicesCommand(CLI::App& program, DevicesArguments& arguments);

/// Lists the Vulkan devices by the numbers that --device takes.
int runDevicesCommand(const DevicesArguments& arguments);

}  // namespace parhelion::app
