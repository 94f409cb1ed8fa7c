#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"

namespace parhelion {

/// Where red, green, blue and white lie in CIE 1931 xy.
struct Chromaticities {
    glm::dvec2 red, green, blue, white;
};

/// Named float channels of one size, row by row from the top, and typed attributes: what an EXR holds.
struct Image {
    using Attribute = std::variant<std::string, double, std::int64_t>;

    glm::uvec2 size{0};
    std::map<std::string, std::vector<float>> channels;  ///< "R", "G", "B", "variance.R", ...; size.x * size.y each
    std::map<std::string, Attribute> attributes;
    std::optional<Chromaticities> chromaticities = {};  ///< of R, G and B, if the file says so
    std::string environmentLayout = {};          ///< "latitude-longitude", "cube" or "unknown", if the file says so
    std::set<std::string> integerChannels = {};  ///< those that the file keeps as whole numbers
    std::vector<std::string> remarks = {};       ///< what the file says of its pixels that is not made use of

    bool has(const std::string& channel) const { return channels.contains(channel); }
};

/// Reads every channel of the data window of an OpenEXR file (scanlines or tiles, first level) as float32: half and
/// float exactly, uint rounded. String, int, float and double attributes are kept; others describe the file.
/// @throws InputError for a missing or damaged file, one with several parts, deep pixels or subsampled channels, and
///         one larger than half of the memory.
/// @param maxSide  largest width and height that are of use; a damaged header's larger ones are refused at once.
Image readExr(const std::filesystem::path& file, unsigned maxSide = ~0u);

/// Writes float32 channels, ZIP compressed, through a temporary file and a rename. Strings, doubles and ints become
/// attributes of those types (int64 beyond int32 as string).
/// @throws InputError if the file cannot be created, RuntimeFailure if writing fails.
void writeExr(const std::filesystem::path& file, const Image& image);

/// Writes channels R G B as an 8-bit sRGB PNG: exposure in stops, then the curve of image/tone_curve.h, which leaves
/// values up to 0.5 untouched and never clips hue (display only; infinities show white, NaN magenta).
/// @throws InputError for missing channels, more than 64 stops either way, or a file that cannot be created.
void writePng(const std::filesystem::path& file, const Image& image, double exposureStops = 0.0);

/// Writes a signed quantity as an 8-bit sRGB PNG: white at 0, red at `range` and above, blue at -range and below; NaN
/// green.
/// @param values  one a pixel, row by row from the top.
/// @throws InputError if the file cannot be created.
void writeSignedPng(const std::filesystem::path& file, glm::uvec2 size, std::span<const float> values, double range);

}  // namespace parhelion
