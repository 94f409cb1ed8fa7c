#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "image/bitmap.h"
#include "image/image.h"

namespace parhelion {

/// A bitmap's file on its way through the reader of its format.
struct BitmapFile {
    const std::filesystem::path& path;
    std::span<const std::byte> content;
    BitmapEncoding encoding;

    std::uint8_t byte(std::size_t at) const { return std::uint8_t(content[at]); }

    /// @throws InputError that blames the file, or a line of it (from 1; 0: the whole).
    [[noreturn]] void fail(const std::string& message, int line = 0) const;
    /// Adds a note about the file, or a line of it, to the bitmap.
    void note(Bitmap& bitmap, const std::string& message, int line = 0) const;

    /// Room for the texels.
    /// @throws InputError before a damaged header makes a decoder ask for what the machine has not.
    Bitmap makeBitmap(std::uint64_t width, std::uint64_t height) const;

    /// What a value in [0, 1] of an 8- or 16-bit file means.
    float linear(float value) const;
};

/// Each reads a file that begins as its format does. Texels may still be negative or not finite.
/// @throws InputError if it is damaged, cut or of a kind that is not supported; see scenes/README.md.
Bitmap readExrBitmap(const BitmapFile& file);
Bitmap readRadianceBitmap(const BitmapFile& file);
Bitmap readPngBitmap(const BitmapFile& file);
Bitmap readJpegBitmap(const BitmapFile& file);

/// Whether a Radiance picture's header begins here; some have no `#?` line.
bool isRadiance(std::span<const std::byte> content);

/// Turns R, G and B of the given primaries into Rec. 709.
/// @throws InputError if they span no colours. @param name  of what states them, @param line  where it does.
void convertPrimaries(const BitmapFile& file, const Chromaticities& space, Bitmap& bitmap, const std::string& name,
                      int line = 0);

}  // namespace parhelion
