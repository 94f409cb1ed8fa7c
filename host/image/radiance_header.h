#pragma once

#include <optional>

#include "image/bitmap_file.h"

namespace parhelion {

/// What stands before the pixels of a Radiance picture.
struct RadianceHeader {
    /// A direction in which pixels follow each other; of a picture, y points up.
    struct Axis {
        bool isY = false, decreases = false;
        std::uint64_t size = 0;
    };

    bool isXyz = false;
    glm::dvec3 divisor{1.0};              ///< EXPOSURE and COLORCORR, all of them: radiance = pixel / divisor
    std::optional<Chromaticities> space;  ///< PRIMARIES
    int spaceLine = 0;                    ///< where it stands
    Axis scanlines, pixels;               ///< from scanline to scanline, and within one
    std::size_t begin = 0;                ///< of the pixels, bytes from the start of the file

    glm::u64vec2 size() const {
        return scanlines.isY ? glm::u64vec2(pixels.size, scanlines.size) : glm::u64vec2(scanlines.size, pixels.size);
    }
};

/// Reads the header and the line of the resolution.
/// @param remarks  takes the notes about what has no effect, or an unusual one.
/// @throws InputError with the line that is wrong.
RadianceHeader readRadianceHeader(const BitmapFile& file, Bitmap& remarks);

}  // namespace parhelion
