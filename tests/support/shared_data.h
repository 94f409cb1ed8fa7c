#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "support/paths.h"

namespace parhelion::test {

/// A file of the data that lies beside the project, or an empty path when there is no such data at all.
/// @throws std::runtime_error when the data is there without the file: a test must not skip for a name that has
/// changed.
inline std::filesystem::path sharedFile(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::path(test::projectFolder()) / ".." / "shared";
    if (!std::filesystem::exists(folder)) return {};
    if (!std::filesystem::exists(folder / name)) throw std::runtime_error("../shared has no " + name);
    return folder / name;
}

}  // namespace parhelion::test
