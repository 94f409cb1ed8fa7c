#pragma once

#include <fmt/format.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <type_traits>

#include "base/error.h"

namespace parhelion {

/// Writes little-endian values to a file; a full disk is a RuntimeFailure.
class ByteWriter {
public:
    explicit ByteWriter(const std::filesystem::path& file) : name_(file.string()), stream_(file, std::ios::binary) {}

    void write(const void* data, std::size_t bytes) {
        stream_.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
    }

    template <typename T>
    void write(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        write(&value, sizeof(T));
    }

    /// Where the next byte goes; seek() overwrites from there.
    std::uint64_t position() { return static_cast<std::uint64_t>(stream_.tellp()); }
    void seek(std::uint64_t position) { stream_.seekp(static_cast<std::streamoff>(position)); }

    /// @throws RuntimeFailure if anything since the start could not be written.
    void close() {
        stream_.close();
        if (!stream_) throw RuntimeFailure(fmt::format("cannot write '{}': {}", name_, std::strerror(errno)));
    }

private:
    std::string name_;
    std::ofstream stream_;
};

}  // namespace parhelion
