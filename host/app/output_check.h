#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace parhelion::app {

/// @param option  blamed: what names the output.
/// @throws InputError if writing `output` would replace one of `inputs`, by whatever path or link it was read.
void refuseReplacing(std::span<const std::filesystem::path> inputs, const std::filesystem::path& output,
                     const std::string& option);

}  // namespace parhelion::app
