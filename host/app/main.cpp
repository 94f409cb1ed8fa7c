#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <new>
#include <optional>
#include <string>

#include "app/compare_command.h"
#include "app/convert_command.h"
#include "app/devices_command.h"
#include "app/exit_codes.h"
#include "app/inspect_command.h"
#include "app/render_command.h"
#include "base/error.h"

namespace parhelion::app {

namespace {

/// CLI11 would only say that a command is missing.
void requireKnownCommand(const CLI::App& program, int argumentCount, char** arguments) {
    if (argumentCount < 2 || arguments[1][0] == '-') return;
    std::string names;
    for (const CLI::App* command : program.get_subcommands({})) {
        if (command->get_name() == arguments[1]) return;
        names += (names.empty() ? "" : ", ") + command->get_name();
    }
    throw InputError(fmt::format("expected a command: {}; got {}", names, arguments[1]));
}

/// @throws InputError for whatever CLI11 refuses. Returns an exit code when there is nothing left to do.
std::optional<int> parse(CLI::App& program, int argumentCount, char** arguments) {
    requireKnownCommand(program, argumentCount, arguments);
    try {
        program.parse(argumentCount, arguments);
        return std::nullopt;
    } catch (const CLI::Success& helpOrVersion) {
        return program.exit(helpOrVersion);
    } catch (const CLI::ParseError& error) {
        const auto parsed = program.get_subcommands();
        const std::string command = parsed.empty() ? "" : parsed.front()->get_name() + " ";
        throw InputError(fmt::format("{} (see parhelion {}--help)", error.what(), command));
    }
}

int parseAndRun(int argumentCount, char** arguments) {
    CLI::App program("Parhelion renders participating media by path tracing, on Vulkan or on the CPU.", "parhelion");
    program.set_version_flag("--version", "parhelion " PARHELION_VERSION);
    program.require_subcommand(1);
    program.footer(
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
    const CLI::App* renderCommand = addRenderCommand(program, render);
    const CLI::App* inspectCommand = addInspectCommand(program, inspect);
    const CLI::App* compareCommand = addCompareCommand(program, compare);
    const CLI::App* convertCommand = addConvertCommand(program, convert);
    addDevicesCommand(program, devices);

    if (const auto exitCode = parse(program, argumentCount, arguments)) return *exitCode;
    if (renderCommand->parsed()) return runRenderCommand(render);
    if (inspectCommand->parsed()) return runInspectCommand(inspect);
    if (compareCommand->parsed()) return runCompareCommand(compare);
    if (convertCommand->parsed()) return runConvertCommand(convert);
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
