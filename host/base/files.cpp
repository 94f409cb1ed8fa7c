#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <random>
#include <system_error>

#include "base/memory.h"

namespace parhelion {

namespace {

namespace fs = std::filesystem;

SourceLocation blame(const fs::path& path, const SourceLocation& where) {
    return where.file.empty() ? SourceLocation{path.string()} : where;
}

template <typename Content>
Content readWhole(const fs::path& path, const SourceLocation& where) {
    Content content(readableFileSize(path, where), {});
    std::ifstream stream(path, std::ios::binary);
    stream.read(reinterpret_cast<char*>(content.data()), static_cast<std::streamsize>(content.size()));
    if (!stream)
        throw InputError(blame(path, where), fmt::format("cannot read '{}': {}", path.string(), std::strerror(errno)));
    return content;
}

/// The file that a write to path must replace.
fs::path resolveDestination(const fs::path& path) {
    if (path.filename().empty()) throw InputError(fmt::format("output must name a file; got '{}'", path.string()));
    std::error_code error;
    const fs::path target = fs::exists(path, error) ? fs::canonical(path) : path;
    if (error) throw InputError(fmt::format("cannot write '{}': {}", path.string(), error.message()));
    // Renaming over a device such as /dev/null would replace the device.
    if (fs::exists(target) && !fs::is_regular_file(target))
        throw InputError(fmt::format("output must be a regular file; got '{}'", path.string()));
    return target;
}

fs::path createBeside(const fs::path& destination) {
    std::random_device random;
    for (;;) {
        const std::string name =
            fmt::format(".{}.{:08x}{}", destination.stem().string(), random(), destination.extension().string());
        const fs::path candidate = destination.parent_path() / name;
        const int descriptor = ::open(candidate.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
        if (descriptor >= 0) {
            ::close(descriptor);
            return candidate;
        }
        if (errno != EEXIST)
            throw InputError(fmt::format("cannot write '{}': {}", destination.string(), std::strerror(errno)));
    }
}

}  // namespace

std::size_t readableFileSize(const fs::path& path, const SourceLocation& where) {
    const SourceLocation blamed = blame(path, where);
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found)
        throw InputError(blamed, fmt::format("file must exist; got '{}'", path.string()));
    if (error) throw InputError(blamed, fmt::format("cannot read '{}': {}", path.string(), error.message()));
    // A pipe or a device could feed bytes for ever.
    if (!fs::is_regular_file(status))
        throw InputError(blamed, fmt::format("must be a regular file; got '{}'", path.string()));
    const auto size = fs::file_size(path, error);
    if (error) throw InputError(blamed, fmt::format("cannot read '{}': {}", path.string(), error.message()));
    if (size > physicalMemoryBytes())
        throw InputError(blamed, fmt::format("file must fit into memory ({} bytes); got '{}' of {} bytes",
                                             physicalMemoryBytes(), path.string(), size));
    return size;
}

std::vector<std::byte> readBinaryFile(const fs::path& path, const SourceLocation& where) {
    return readWhole<std::vector<std::byte>>(path, where);
}

std::string readTextFile(const fs::path& path, const SourceLocation& where) {
    return readWhole<std::string>(path, where);
}

AtomicFile::AtomicFile(const fs::path& destination)
    : destination_(resolveDestination(destination)), temporary_(createBeside(destination_)) {}

AtomicFile::~AtomicFile() {
    if (committed_) return;
    std::error_code ignored;  // a destructor has no one to tell
    fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
    const int descriptor = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
    const bool flushed = descriptor >= 0 && ::fsync(descriptor) == 0;
    const int reason = errno;
    if (descriptor >= 0) ::close(descriptor);
    if (!flushed)
        throw RuntimeFailure(fmt::format("cannot write '{}': {}", destination_.string(), std::strerror(reason)));
    std::error_code error;
    fs::rename(temporary_, destination_, error);
    if (error) throw RuntimeFailure(fmt::format("cannot write '{}': {}", destination_.string(), error.message()));
    committed_ = true;
}

void writeAtomically(const fs::path& path, std::span<const std::byte> content) {
    AtomicFile file(path);
    std::ofstream stream(file.temporaryPath(), std::ios::binary);
    stream.write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
    stream.close();
    if (!stream) throw RuntimeFailure(fmt::format("cannot write '{}': {}", path.string(), std::strerror(errno)));
    file.commit();
}

void writeAtomically(const fs::path& path, std::string_view content) {
    writeAtomically(path, std::as_bytes(std::span(content)));
}

}  // namespace parhelion
