#include "gpu/cache.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>

#include "base/files.h"

namespace parhelion::gpu {
namespace fs = std::filesystem;
namespace {

/// A folder another user prepared (in the temporary folder, say) could feed us code: only our own counts.
bool isOwnWritableFolder(const fs::path& folder) {
    struct stat status {};
    return ::lstat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == ::geteuid() &&
           ::access(folder.c_str(), W_OK | X_OK) == 0;
}

struct Root {
    fs::path path;
    bool temporary;
};

std::vector<Root> cacheRoots() {
    std::vector<Root> roots;
    const char* cacheHome = std::getenv("XDG_CACHE_HOME");
    if (cacheHome && fs::path(cacheHome).is_absolute()) roots.push_back({fs::path(cacheHome) / "parhelion", false});
    const char* home = std::getenv("HOME");
    if (home && fs::path(home).is_absolute()) roots.push_back({fs::path(home) / ".cache" / "parhelion", false});
    std::error_code failed;
    const fs::path temporary = fs::temp_directory_path(failed);
    if (!failed) roots.push_back({temporary / fmt::format("parhelion-{}", ::geteuid()), true});
    return roots;
}

/// The folder `part` of a root, made when missing; empty where it cannot be written.
fs::path folderIn(const fs::path& root, std::string_view part) {
    std::error_code failed;
    fs::create_directories(root, failed);
    if (!isOwnWritableFolder(root)) return {};
    const fs::path folder = root / part;
    fs::create_directories(folder, failed);
    return isOwnWritableFolder(folder) ? folder : fs::path();
}

}  // namespace

fs::path cacheFolder(std::string_view part) {
    for (const Root& root : cacheRoots())
        if (const fs::path folder = folderIn(root.path, part); !folder.empty()) return folder;
    return {};
}

std::string cacheNote() {
    std::string refused;
    for (const Root& root : cacheRoots()) {
        const fs::path folder = folderIn(root.path, "spirv");
        if (folder.empty()) {
            refused += (refused.empty() ? "" : " or ") + root.path.string();
            continue;
        }
        if (!root.temporary) return {};
        return fmt::format(
            "{}; compiled shaders are kept in {}, and are compiled again, for a second or more, once that is emptied: "
            "set "
            "XDG_CACHE_HOME to a folder that can be written",
            refused.empty() ? "neither XDG_CACHE_HOME nor HOME names a folder" : refused + " cannot be written",
            root.path.string());
    }
    return fmt::format(
        "{} cannot be written; shaders are compiled at every start, for a second or more: set XDG_CACHE_HOME to a "
        "folder "
        "that can be written",
        refused.empty() ? "the temporary folder" : refused);
}

std::uint64_t contentHash(std::span<const std::byte> bytes, std::uint64_t hash) {
    for (const std::byte byte : bytes) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3ull;
    return hash;
}

std::uint64_t contentHash(std::string_view text, std::uint64_t hash) {
    return contentHash(std::as_bytes(std::span(text)), hash);
}

std::vector<std::byte> readCacheFile(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::string stored{std::istreambuf_iterator<char>(in), {}};
    std::uint64_t checksum = 0;
    if (stored.size() < sizeof checksum) return {};
    std::memcpy(&checksum, stored.data(), sizeof checksum);
    const auto content = std::as_bytes(std::span(stored)).subspan(sizeof checksum);
    if (contentHash(content) != checksum) return {};
    return {content.begin(), content.end()};
}

void writeCacheFile(const fs::path& file, std::span<const std::byte> bytes) {
    const std::uint64_t checksum = contentHash(bytes);
    std::vector<std::byte> stored(sizeof checksum);
    std::memcpy(stored.data(), &checksum, sizeof checksum);
    stored.insert(stored.end(), bytes.begin(), bytes.end());
    try {
        writeAtomically(file, stored);
    } catch (const std::exception&) {
        // The next run rebuilds what this one did.
    }
}

}  // namespace parhelion::gpu
