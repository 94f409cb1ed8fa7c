#include "app/devices_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/exit_codes.h"
#include "app/text_format.h"
#include "gpu/device.h"

namespace parhelion::app {

Command addDevicesCommand(CommandLine& program, DevicesArguments& arguments) {
    Command command = program.addCommand("devices", "List the Vulkan devices that can render");
    command.addFlag("--json", arguments.json, "print as JSON");
    command.setFooter(
        "Examples:\n"
        "  parhelion devices\n"
        "  parhelion render cloud.xml --device llvmpipe");
    return command;
}

int runDevicesCommand(const DevicesArguments& arguments) {
    const std::vector<gpu::DeviceInfo> devices = gpu::listDevices();
    if (arguments.json) {
        auto json = nlohmann::ordered_json::array();
        for (const gpu::DeviceInfo& device : devices)
            json.push_back({{"name", device.name},
                            {"driver", device.driver},
                            {"type", device.type},
                            {"software", device.software}});
        printJson(json);
        return kExitSuccess;
    }
    for (std::size_t i = 0; i < devices.size(); ++i)
        fmt::print("{}  {} ({}, {})\n", i, devices[i].name, devices[i].type, devices[i].driver);
    return kExitSuccess;
}

}  // namespace parhelion::app
