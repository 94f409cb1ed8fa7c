#pragma once

#include "app/command_line.h"

namespace parhelion::app {

struct DevicesArguments {
    bool json = false;
};

Command addDevicesCommand(CommandLine& program, DevicesArguments& arguments);

/// Lists the Vulkan devices by the numbers that --device takes.
int runDevicesCommand(const DevicesArguments& arguments);

}  // namespace parhelion::app
