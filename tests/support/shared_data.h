#pragma once

#include <filesystem>
#include <string>

namespace parhelion::test {

/// A file of the data that lies beside the project, or an empty path when it is not there.
inline std::filesystem::path sharedFile(const std::string& name) {
    const std::filesystem::path file = std::filesystem::path(PARHELION_ROOT) / ".." / "shared" / name;
    return std::filesystem::exists(file) ? file : std::filesystem::path();
}

}  // namespace parhelion::test
