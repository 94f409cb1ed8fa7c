#include "image/embedded_metadata.h"

#include <cstdint>
#include <string_view>

namespace parhelion {

namespace {

/// Numbers of a TIFF structure in its own byte order; 0 beyond its end.
class TiffNumbers {
public:
    explicit TiffNumbers(std::span<const std::byte> tiff) : tiff_(tiff), isBigEndian_(byte(0) == 'M') {}

    std::uint32_t at(std::size_t offset, int bytes) const {
        std::uint32_t result = 0;
        for (int i = 0; i < bytes; ++i)
            result = result << 8 | byte(offset + std::size_t(isBigEndian_ ? i : bytes - 1 - i));
        return result;
    }

private:
    std::uint8_t byte(std::size_t offset) const { return offset < tiff_.size() ? std::uint8_t(tiff_[offset]) : 0; }

    std::span<const std::byte> tiff_;
    bool isBigEndian_;
};

}  // namespace

std::optional<unsigned> exifOrientation(std::span<const std::byte> tiff) {
    constexpr std::uint32_t kOrientation = 0x0112;
    constexpr std::size_t kEntry = 12;
    const TiffNumbers numbers(tiff);
    const std::size_t directory = numbers.at(4, 4), entries = numbers.at(directory, 2);
    for (std::size_t i = 0; i < entries && directory + 2 + (i + 1) * kEntry <= tiff.size(); ++i) {
        const std::size_t entry = directory + 2 + i * kEntry;
        const std::uint32_t value = numbers.at(entry + 8, 2);
        if (numbers.at(entry, 2) == kOrientation && value >= 1 && value <= 8) return value;
    }
    return std::nullopt;
}

bool namesSrgb(std::span<const std::byte> profile) {
    const std::string_view text(reinterpret_cast<const char*>(profile.data()), profile.size());
    using namespace std::string_view_literals;
    return text.find("sRGB"sv) != std::string_view::npos || text.find("s\0R\0G\0B"sv) != std::string_view::npos;
}

}  // namespace parhelion
