#include "app/inspect_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/cloud_reports.h"
#include "app/exit_codes.h"
#include "app/scene_inventory.h"
#include "app/text_format.h"
#include "compile/compile_scene.h"

namespace parhelion::app {

Command addInspectCommand(CommandLine& program, InspectArguments& arguments) {
    Command command =
        program.addCommand("inspect", "Show what a scene holds, what it costs and which effects it calls for");
    addSceneOptions(command, arguments.scene);
    command.addFlag("--bake-error", arguments.bakeError, kBakeErrorHelp);
    command.addFlag("--json", arguments.json, "print as JSON");
    command.setFooter(
        "Examples:\n"
        "  parhelion inspect scenes/cloud_box.xml\n"
        "  parhelion inspect cloud.xml -D volume=dense.vdb --json");
    return command;
}

int runInspectCommand(const InspectArguments& arguments) {
    CompileOptions options;
    options.size = arguments.scene.size;
    SceneDescription description = readScene(arguments.scene);
    const std::vector<CloudBakeReport> clouds =
        bakeClouds(description, twinBaker(), {.measureError = arguments.bakeError});
    const SceneInventory inventory = takeInventory(compileScene(description, options));
    if (arguments.json) {
        nlohmann::ordered_json json = toJson(inventory);
        json["clouds"] = toJson(clouds);
        printJson(json);
    } else {
        fmt::print("{}{}", describe(clouds), describe(inventory));
    }
    return kExitSuccess;
}

}  // namespace parhelion::app
