#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

#include "base/error.h"

namespace parhelion {

/// Linear Rec. 709 colours, row by row from the top.
struct Bitmap {
    glm::uvec2 size{0};
    std::vector<glm::vec3> texels;  ///< size.x * size.y

    const glm::vec3& at(unsigned x, unsigned y) const { return texels[std::size_t(y) * size.x + x]; }
};

/// What the numbers of an 8- or 16-bit file mean. EXR and HDR files are always linear.
enum class BitmapEncoding {
    kSrgb,  ///< decoded to linear
    kRaw    ///< as they are, scaled to [0, 1]
};

/// Largest width and height of a bitmap.
inline constexpr unsigned kMaxBitmapSize = 65536;

/// Reads .exr, .hdr (Radiance), .png or .jpg, told apart by content. One channel is grey; alpha is ignored. An EXR may
/// also hold X, Y and Z or Y, RY and BY; its R, G and B are converted from the primaries that it states.
///
/// @param where  blamed for a missing file (the scene's location of the name); the file itself is blamed for damage.
/// @throws InputError for a missing, truncated, damaged or too large file, for channels that are none of these and for
///         primaries that span no colours; naming the first texel that is negative or not finite.
Bitmap readBitmap(const std::filesystem::path& file, const SourceLocation& where,
                  BitmapEncoding encoding = BitmapEncoding::kSrgb);

}  // namespace parhelion
