#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace parhelion::test {

/// An empty folder of its own, removed with everything in it.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Writes a file, bytes as they are; returns its path.
    std::filesystem::path write(const std::string& name, const std::string& content) const;
    /// Names of everything inside, hidden files included.
    std::set<std::string> names() const;

private:
    std::filesystem::path path_;
};

}  // namespace parhelion::test
