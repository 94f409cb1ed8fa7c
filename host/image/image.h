#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

#include "base/error.h"

namespace parhelion {

/// Named float channels of one size, row by row from the top, and typed attributes: what an EXR holds.
struct Image {
    using Attribute = std::variant<std::string, double, std::int64_t>;

    glm::uvec2 size{0};
    std::map<std::string, std::vector<float>> channels;  ///< "R", "G", "B", "variance.R", ...; size.x * size.y each
    std::map<std::string, Attribute> attributes;

    bool has(const std::string& channel) const { return channels.contains(channel); }
};

/// Reads every channel of a (single-part) OpenEXR file as float32.
/// @throws InputError for a missing or damaged file.
Image readExr(const std::filesystem::path& file);

/// Writes float32 channels, ZIP compressed, through a temporary file and a rename. Strings, doubles and ints become
/// attributes of those types (int64 beyond int32 as string).
void writeExr(const std::filesystem::path& file, const Image& image);

/// Writes channels R G B as an 8-bit sRGB PNG: exposure in stops, then a filmic curve that leaves
/// values below 0.5 nearly untouched and never clips hue (display only; infinities show white, NaN magenta).
void writePng(const std::filesystem::path& file, const Image& image, double exposureStops = 0.0);

}  // namespace parhelion
