#pragma once

#include <string>

#include "app/command_line.h"
#include "volume/volume_file.h"

namespace parhelion::app {

struct ConvertArguments {
    std::string input, output;
    std::string grid;  ///< name of the grid in a .vdb or .nvdb; empty: see VolumeReadOptions
    VolumeWriteOptions write;
};

Command addConvertCommand(CommandLine& program, ConvertArguments& arguments);

/// Reads a volume in one format and writes it in another.
int runConvertCommand(const ConvertArguments& arguments);

}  // namespace parhelion::app
