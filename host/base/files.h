#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace parhelion {

/// Size of a file that is about to be read, bytes.
///
/// @param where  blamed when the file cannot be read: the place that names it. Without a file: the path itself.
/// @throws InputError if it is missing, not a regular file, or larger than the machine's memory.
std::size_t readableFileSize(const std::filesystem::path& path, const SourceLocation& where = {});

/// Reads a whole file.
///
/// @throws InputError as readableFileSize, and if reading fails.
std::vector<std::byte> readBinaryFile(const std::filesystem::path& path, const SourceLocation& where = {});

/// As readBinaryFile, as text; bytes are kept as they are (no newline or encoding conversion).
std::string readTextFile(const std::filesystem::path& path, const SourceLocation& where = {});

/// A file that appears whole or not at all: written under a temporary name in the destination's folder, renamed by
/// commit(), removed by the destructor when commit() was not reached. The name keeps the destination's extension.
class AtomicFile {
public:
    /// Creates the (empty) temporary file. A symbolic link is followed: its target is replaced, the link stays.
    /// @throws InputError if the folder is missing or not writable, or the destination exists and is not a regular
    /// file.
    explicit AtomicFile(const std::filesystem::path& destination);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Where to write. Close the file before commit().
    const std::filesystem::path& temporaryPath() const { return temporary_; }

    /// Flushes the content to the disk and gives it the destination's name.
    /// @throws RuntimeFailure if the system refuses.
    void commit();

private:
    std::filesystem::path destination_;
    std::filesystem::path temporary_;
    bool committed_ = false;
};

/// Writes a whole file through AtomicFile.
/// @throws InputError as AtomicFile, RuntimeFailure if writing fails (disk full).
void writeAtomically(const std::filesystem::path& path, std::span<const std::byte> content);
void writeAtomically(const std::filesystem::path& path, std::string_view content);

}  // namespace parhelion
