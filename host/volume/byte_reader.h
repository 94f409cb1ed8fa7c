#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

#include "base/error.h"

namespace parhelion {

/// Reads little-endian values front to back and never past the end: too few bytes are an InputError.
class ByteReader {
public:
    ByteReader(std::span<const std::byte> bytes, SourceLocation where) : bytes_(bytes), where_(std::move(where)) {}

    std::uint64_t offset() const { return offset_; }
    std::uint64_t remaining() const { return bytes_.size() - offset_; }
    const SourceLocation& where() const { return where_; }

    /// The next `count` bytes. `what` names them in the error.
    std::span<const std::byte> take(std::uint64_t count, std::string_view what) {
        if (count > remaining())
            fail(fmt::format("truncated or damaged: {} needs {} bytes, {} remain", what, count, remaining()));
        const auto taken = bytes_.subspan(offset_, count);
        offset_ += count;
        return taken;
    }

    template <typename T>
    T read(std::string_view what) {
        static_assert(std::is_trivially_copyable_v<T>);
        T value;
        std::memcpy(&value, take(sizeof(T), what).data(), sizeof(T));
        return value;
    }

    [[noreturn]] void fail(const std::string& message) const {
        throw InputError(where_, fmt::format("byte {}: {}", offset_, message));
    }

private:
    std::span<const std::byte> bytes_;
    std::uint64_t offset_ = 0;
    SourceLocation where_;
};

}  // namespace parhelion
