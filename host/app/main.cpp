#include <fmt/format.h>

#include <exception>
#include <new>
#include <optional>

#include "app/command_line.h"
#include "app/compare_command.h"
#include "app/convert_command.h"
#include "app/devices_command.h"
#include "app/exit_codes.h"
#include "app/inspect_command.h"
#include "app/render_command.h"
#include "base/error.h"

namespace parhelion::app {

namespace {

int parseAndRun(int argumentCount, char** arguments) {
    CommandLine program("parhelion", PARHELION_VERSION,
                        "Parhelion renders participating media by path tracing, on Vulkan or on the CPU.",
                        "Examples:\n"
                        "  parhelion render scenes/cloud_box.xml -o cloud.exr --spp 64\n"
                        "  parhelion inspect scenes/cloud_box.xml\n"
                        "  parhelion compare cloud.exr oracle.exr --max-relmse 0.01\n\n"
                        "Each command explains itself: parhelion render --help");

    RenderArguments render;
    InspectArguments inspect;
    CompareArguments compare;
    ConvertArguments convert;
    DevicesArguments devices;
    const Command renderCommand = addRenderCommand(program, render);
    const Command inspectCommand = addInspectCommand(program, inspect);
    const Command compareCommand = addCompareCommand(program, compare);
    const Command convertCommand = addConvertCommand(program, convert);
    addDevicesCommand(program, devices);

    if (const auto exitCode = program.parse(argumentCount, arguments)) return *exitCode;
    if (renderCommand.isChosen()) return runRenderCommand(render);
    if (inspectCommand.isChosen()) return runInspectCommand(inspect);
    if (compareCommand.isChosen()) return runCompareCommand(compare);
    if (convertCommand.isChosen()) return runConvertCommand(convert);
    return runDevicesCommand(devices);
}

int fail(int exitCode, const char* message) {
    fmt::print(stderr, "parhelion: error: {}\n", message);
    return exitCode;
}

}  // namespace

}  // namespace parhelion::app

int main(int argumentCount, char** arguments) {
    using namespace parhelion;
    using namespace parhelion::app;
    try {
        return parseAndRun(argumentCount, arguments);
    } catch (const InputError& error) {
        return fail(kExitInput, error.what());
    } catch (const std::bad_alloc&) {
        return fail(kExitRuntime, "out of memory: a smaller film, grid or mesh may fit");
    } catch (const std::exception& error) {
        return fail(kExitRuntime, error.what());
    }
}
