#include "app/convert_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/exit_codes.h"
#include "app/interrupt.h"
#include "app/options.h"
#include "app/output_check.h"
#include "app/text_format.h"
#include "base/files.h"

namespace parhelion::app {

namespace {

std::string describe(const Volume& volume) {
    const glm::dvec3 low = volume.boundsMin, high = volume.boundsMax;
    const std::string bounds = fmt::format("bounds {:.6g}, {:.6g}, {:.6g} to {:.6g}, {:.6g}, {:.6g}", low.x, low.y,
                                           low.z, high.x, high.y, high.z);
    if (volume.channels != 1)
        return fmt::format("{} voxels of {} channels, {}, {}", formatSize(volume.color.resolution), volume.channels,
                           formatBytes(static_cast<double>(volume.color.values.size() * sizeof(float))), bounds);
    const auto table = volume.density.brickTable();
    const auto empty = std::count(table.begin(), table.end(), DensityGrid::kEmpty);
    const double occupancy = 1.0 - static_cast<double>(empty) / static_cast<double>(table.size());
    return fmt::format("{} voxels, {} of the bricks occupied, {}, largest value {}, {}",
                       formatSize(volume.density.resolution()), formatPercent(occupancy),
                       formatBytes(static_cast<double>(volume.density.memoryBytes())), volume.density.maximum(),
                       bounds);
}

}  // namespace

Command addConvertCommand(CommandLine& program, ConvertArguments& arguments) {
    Command command = program.addCommand("convert", "Convert a volume between .vol, .grid, .vdb and .nvdb");
    command.addArgument("IN", arguments.input, "volume to read; its content tells the format");
    command.addArgument("OUT", arguments.output, "volume to write; its extension tells the format");
    addTextOption(command, "--grid", arguments.grid, "NAME",
                  "grid to read of a .vdb or .nvdb (default: density, else the first)");
    addChoiceOption<GridValueType, GridValueType>(command, "--values", arguments.write.valueType,
                                                  {{"float32", GridValueType::kFloat32},
                                                   {"float16", GridValueType::kFloat16},
                                                   {"unorm8", GridValueType::kUnorm8}},
                                                  "how a .grid stores its values (default float32: exact)");
    command.setFooter(
        "Examples:\n"
        "  parhelion convert bunny_cloud.vdb bunny_cloud.vol\n"
        "  parhelion convert fire.vdb smoke.nvdb --grid density");
    return command;
}

int runConvertCommand(const ConvertArguments& arguments) {
    Interruption interruption;
    const std::filesystem::path input = arguments.input;
    refuseReplacing({&input, 1}, arguments.output, "OUT");
    { const AtomicFile probe(arguments.output); }
    const Volume volume = readVolume(arguments.input, {.file = arguments.input},
                                     {.gridName = arguments.grid, .gridNameWhere = {"--grid"}});
    {
        const auto lock = interruption.holdOff();
        writeVolume(arguments.output, volume, arguments.write);
    }
    fmt::print("read      {}: {}\n", volume.source, describe(volume));
    if (!volume.note.empty()) fmt::print("note      {}\n", volume.note);
    fmt::print("wrote     {}: {}\n", arguments.output,
               formatBytes(static_cast<double>(std::filesystem::file_size(arguments.output))));
    return kExitSuccess;
}

}  // namespace parhelion::app
