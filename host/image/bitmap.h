#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "base/error.h"

namespace parhelion {

/// Linear Rec. 709 colours, row by row from the top.
struct Bitmap {
    glm::uvec2 size{0};
    std::vector<glm::vec3> texels;  ///< size.x * size.y
    std::vector<std::string> notes =
        {};  ///< what was accepted though it changes or drops something; each names the file
    std::string environmentLayout = {};  ///< "latitude-longitude", "cube" or "unknown" where an EXR says; else empty

    const glm::vec3& at(unsigned x, unsigned y) const { return texels[std::size_t(y) * size.x + x]; }
};

/// What the numbers of an 8- or 16-bit file mean. EXR and HDR files are always linear.
enum class BitmapEncoding {
    kSrgb,  ///< decoded to linear
    kRaw    ///< as they are, scaled to [0, 1]
};

/// Largest width and height of a bitmap.
inline constexpr unsigned kMaxBitmapSize = 65536;

/// A negative texel is taken for 0 (and counted in a note) up to this share of the largest texel: half a step of an
/// 8-bit picture whose white that is. Lossy compression and filters leave such texels where a picture is black.
inline constexpr double kNegligibleTexel = 1.0 / 510.0;
/// Together they may be this share of all the light in the bitmap: the rounding of half precision.
inline constexpr double kNegligibleLight = 1.0 / 2048.0;

/// Reads .exr, .hdr (Radiance), .png or .jpg, told apart by content. One channel is grey; alpha is ignored. An EXR may
/// also hold X, Y and Z or Y, RY and BY, in one layer; its R, G and B, like a Radiance file's, are converted from the
/// primaries that it states. What is accepted of each format: scenes/README.md.
///
/// @param where  blamed for a missing file (the scene's location of the name); the file itself is blamed for damage.
/// @throws InputError for a missing, truncated, damaged or too large file, for channels that are none of these and for
///         primaries that span no colours; naming the first texel that is not finite, or negative beyond
///         kNegligibleTexel or kNegligibleLight.
Bitmap readBitmap(const std::filesystem::path& file, const SourceLocation& where,
                  BitmapEncoding encoding = BitmapEncoding::kSrgb);

}  // namespace parhelion
