#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace parhelion::test {

/// The bytes as zlib packs them.
std::string deflated(const std::string& bytes);

/// A chunk of a PNG with its checksum.
std::string pngChunk(const std::string& type, const std::string& content);

/// What a PNG file holds.
struct PngPicture {
    unsigned width = 1, height = 1;
    unsigned bits = 8;       ///< a sample
    unsigned colorType = 2;  ///< 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGB and alpha
    bool isInterlaced = false;
    std::vector<unsigned> samples;  ///< of one texel after another, row by row
    std::string chunks = {};        ///< between header and pixels, whole

    unsigned channels() const { return colorType == 2 ? 3 : colorType == 4 ? 2 : colorType == 6 ? 4 : 1; }
};

/// Its bytes: every row unfiltered, made without any PNG library.
std::string pngFile(const PngPicture& picture);

/// What a JPEG file holds.
struct JpegPicture {
    enum class Colours {
        kGrey,
        kRgb,       ///< stored as luminance and chroma
        kTwo,       ///< two components that mean nothing
        kInks,      ///< C, M, Y, K without Adobe's marker: 255 is all ink
        kAdobeInks  ///< with it: 255 is no ink
    };
    unsigned width = 8, height = 8;
    Colours colours = Colours::kRgb;
    std::vector<std::uint8_t> samples;  ///< of one texel after another, row by row
    bool isProgressive = false, isArithmetic = false, hasScanPerComponent = false;
    std::vector<std::pair<int, std::string>> markers = {};  ///< number of APPn, content

    unsigned channels() const {
        return colours == Colours::kGrey ? 1 : colours == Colours::kTwo ? 2 : colours == Colours::kRgb ? 3 : 4;
    }
};

/// Its bytes, at the highest quality, chroma at every texel. @throws std::runtime_error with what libjpeg says.
std::string jpegFile(const JpegPicture& picture);

/// The EXIF data of a picture that a camera took in the given orientation, 1 to 8, in either byte order.
std::string exifData(unsigned orientation, bool isBigEndian);

}  // namespace parhelion::test
