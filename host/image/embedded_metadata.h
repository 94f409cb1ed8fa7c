#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace parhelion {

/// The orientation that EXIF data state, 1 (upright) to 8; empty without one. Damaged data state none.
/// @param tiff  from the byte order on: a PNG's eXIf chunk, or what follows "Exif" and two zeros in a JPEG.
std::optional<unsigned> exifOrientation(std::span<const std::byte> tiff);

/// Whether an ICC profile calls itself sRGB, in one or two bytes a letter.
bool namesSrgb(std::span<const std::byte> profile);

}  // namespace parhelion
