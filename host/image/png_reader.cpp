#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "image/bitmap_file.h"
#include "image/color_space.h"
#include "image/embedded_metadata.h"

namespace parhelion {

namespace {

/// What the chunks of a PNG say before any of them is decoded.
struct PngChunks {
    std::uint64_t width = 0, height = 0;
    unsigned bitsPerTexel = 0;
    std::uint64_t compressed = 0;  ///< bytes of pixels
    std::size_t end = 0;           ///< behind the last chunk
    bool isAnimated = false;
    bool hasOtherSpace = false;  ///< a cICP chunk that says anything but sRGB
};

std::uint32_t bigEndian(const BitmapFile& file, std::size_t at) {
    std::uint32_t result = 0;
    for (std::size_t i = 0; i < 4; ++i) result = result << 8 | file.byte(at + i);
    return result;
}

std::string_view chunkType(const BitmapFile& file, std::size_t at) {
    return {reinterpret_cast<const char*>(file.content.data()) + at + 4, 4};
}

/// Takes from one chunk what is wanted. @param data  where its content begins, @param length  bytes of it.
void readChunk(const BitmapFile& file, std::string_view type, std::size_t data, std::size_t length, PngChunks& chunks) {
    if (type == "CgBI")
        file.fail(
            "must be a PNG of the standard; got one that Apple's tools rewrote for iPhones (chunk CgBI: red and blue "
            "swapped, alpha multiplied in). `sips` or `pngcrush -revert-iphone-optimizations` turn it back");
    if (type == "IHDR" && length >= 13) {
        // libpng goes by the first: buffers of the last one's size would be too small.
        if (chunks.width > 0) file.fail("must have one header (chunk IHDR); got a second one");
        constexpr std::array<unsigned, 7> kChannels{1, 1, 3, 1, 2, 1, 4};  // by colour type
        chunks.width = bigEndian(file, data);
        chunks.height = bigEndian(file, data + 4);
        chunks.bitsPerTexel = file.byte(data + 8) * kChannels[std::min<std::size_t>(file.byte(data + 9), 6)];
    }
    if (type == "IDAT") chunks.compressed += length;
    if (type == "acTL") chunks.isAnimated = true;
    // Primaries of BT.709 (1), the curve of sRGB (13), no matrix, full range.
    if (type == "cICP" && length >= 4) chunks.hasOtherSpace = bigEndian(file, data) != 0x010d0001u;
}

PngChunks scanChunks(const BitmapFile& file) {
    PngChunks chunks;
    for (std::size_t at = 8;;) {
        const std::size_t left = file.content.size() - at;
        if (left < 12)
            file.fail(fmt::format("must be a whole .png file; it ends after {} bytes without its last chunk, IEND",
                                  file.content.size()));
        const std::size_t length = bigEndian(file, at);
        const std::string_view type = chunkType(file, at);
        if (length > left - 12)
            file.fail(fmt::format("must be a whole .png file; a chunk at byte {} of {} says that it has {} bytes", at,
                                  file.content.size(), length));
        readChunk(file, type, at + 8, length, chunks);
        at += 12 + length;
        if (type == "IEND") {
            chunks.end = at;
            return chunks;
        }
    }
}

/// @throws InputError if deflate, which makes at most 1032 bytes of one, cannot have packed that many texels.
void requirePlausibleSize(const BitmapFile& file, const PngChunks& chunks) {
    const double needed = double(chunks.width) * double(chunks.height) * chunks.bitsPerTexel / 8.0;
    if (needed > 1032.0 * double(chunks.compressed))
        file.fail(fmt::format("must be a whole .png file; its {} bytes of pixels cannot hold {} x {} texels",
                              chunks.compressed, chunks.width, chunks.height));
}

/// libpng's state. Its errors jump over C++ frames, so that what runs in attempt() must own nothing.
class PngDecoder {
public:
    PngDecoder(const BitmapFile& file, Bitmap& bitmap) : file_(file), bitmap_(bitmap) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &PngDecoder::onError, &PngDecoder::onWarning);
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
        if (!info_) throw RuntimeFailure("libpng: out of memory");
        png_set_user_limits(png_, kMaxBitmapSize, kMaxBitmapSize);
        // Of texts, which nothing here reads, and profiles: 8 MB each and 1000 of them unless told otherwise.
        png_set_chunk_malloc_max(png_, 4u << 20);
        png_set_chunk_cache_max(png_, 16);
        png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_WARN_DISCARD);
        png_set_read_fn(png_, this, &PngDecoder::onRead);
    }
    ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngDecoder(const PngDecoder&) = delete;
    PngDecoder& operator=(const PngDecoder&) = delete;

    /// Runs part(png, info). @throws InputError for what libpng calls an error.
    template <typename Part>
    void attempt(const Part& part) {
        if (!run(part)) file_.fail(fmt::format("must be an undamaged .png file; libpng says: {}", message_.data()));
    }

private:
    template <typename Part>
    bool run(const Part& part) {
        if (setjmp(png_jmpbuf(png_))) return false;
        part(png_, info_);
        return true;
    }

    static void onError(png_structp png, png_const_charp message) {
        auto& self = *static_cast<PngDecoder*>(png_get_error_ptr(png));
        std::strncpy(self.message_.data(), message, self.message_.size() - 1);
        png_longjmp(png, 1);
    }

    static void onWarning(png_structp png, png_const_charp message) {
        constexpr std::size_t kMaxNotes = 16;
        // sRGB profiles of old programs, which differ from sRGB in nothing that matters.
        if (std::string_view(message).find("known incorrect sRGB profile") != std::string_view::npos) return;
        auto& self = *static_cast<PngDecoder*>(png_get_error_ptr(png));
        if (self.bitmap_.notes.size() < kMaxNotes)
            self.file_.note(self.bitmap_, fmt::format("libpng warns: {}", message));
    }

    static void onRead(png_structp png, png_bytep target, std::size_t size) {
        auto& self = *static_cast<PngDecoder*>(png_get_io_ptr(png));
        if (size > self.file_.content.size() - self.at_) png_error(png, "the file is cut off");
        std::memcpy(target, self.file_.content.data() + self.at_, size);
        self.at_ += size;
    }

    const BitmapFile& file_;
    Bitmap& bitmap_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::size_t at_ = 0;
    std::array<char, 256> message_{};
};

/// What a PNG says of its colours and its orientation.
struct PngMetadata {
    int hasSrgb = 0, hasGamma = 0, hasPrimaries = 0;
    int gamma = 0;                      ///< in 1e-5
    std::array<double, 8> primaries{};  ///< white, red, green, blue
    png_charp profileName = nullptr;
    png_bytep profile = nullptr;
    png_uint_32 profileSize = 0;
    png_bytep exif = nullptr;
    png_uint_32 exifSize = 0;
};

PngMetadata metadataOf(PngDecoder& decoder) {
    PngMetadata m;
    decoder.attempt([&m](png_structp png, png_infop info) {
        int intent = 0, compression = 0;
        std::array<double, 8>& p = m.primaries;
        png_get_iCCP(png, info, &m.profileName, &compression, &m.profile, &m.profileSize);
        m.hasSrgb = png_get_valid(png, info, PNG_INFO_sRGB) && png_get_sRGB(png, info, &intent);
        m.hasGamma = png_get_valid(png, info, PNG_INFO_gAMA) && png_get_gAMA_fixed(png, info, &m.gamma);
        m.hasPrimaries = png_get_valid(png, info, PNG_INFO_cHRM) &&
                         png_get_cHRM(png, info, &p[0], &p[1], &p[2], &p[3], &p[4], &p[5], &p[6], &p[7]);
        png_get_eXIf_1(png, info, &m.exifSize, &m.exif);
    });
    return m;
}

/// Files are taken for sRGB whatever they say, as in Mitsuba; what they say is noted where it is something else.
void noteColours(const BitmapFile& file, const PngMetadata& m, bool hasOtherSpace, Bitmap& bitmap) {
    if (file.encoding == BitmapEncoding::kRaw) return;
    constexpr const char* kTaken = "has no effect: colours are taken for sRGB, as in Mitsuba";
    constexpr int kSrgbGamma = 45455, kTolerance = 2300;  // 5 %, as libpng compares
    const Chromaticities& s = kRec709;
    const std::array<double, 8> srgb{s.white.x, s.white.y, s.red.x, s.red.y, s.green.x, s.green.y, s.blue.x, s.blue.y};
    double difference = 0.0;
    for (std::size_t i = 0; i < srgb.size(); ++i) difference = std::max(difference, std::abs(m.primaries[i] - srgb[i]));
    if (hasOtherSpace) file.note(bitmap, fmt::format("the colour space of chunk cICP {}", kTaken));
    if (m.hasSrgb || hasOtherSpace) return;
    if (m.profile) {
        const std::string_view name = m.profileName;
        if (!namesSrgb(std::as_bytes(std::span(name))) &&
            !namesSrgb(std::as_bytes(std::span(m.profile, m.profileSize))))
            file.note(bitmap, fmt::format("the colour profile of chunk iCCP {}", kTaken));
        return;
    }
    if (m.hasGamma && std::abs(m.gamma - kSrgbGamma) > kTolerance)
        file.note(bitmap, fmt::format("gAMA {} {}", m.gamma * 1e-5, kTaken));
    if (m.hasPrimaries && difference > 2e-3) file.note(bitmap, fmt::format("cHRM {}", kTaken));
}

void noteMetadata(const BitmapFile& file, const PngChunks& chunks, PngDecoder& decoder, Bitmap& bitmap) {
    const PngMetadata metadata = metadataOf(decoder);
    noteColours(file, metadata, chunks.hasOtherSpace, bitmap);
    if (const auto exif = exifOrientation(std::as_bytes(std::span(metadata.exif, metadata.exifSize)));
        exif.value_or(1) != 1)
        file.note(bitmap, fmt::format("its EXIF orientation, {}, has no effect, as in Mitsuba", *exif));
    if (chunks.isAnimated) file.note(bitmap, "of the animation its still picture is read");
    if (chunks.end < file.content.size())
        file.note(bitmap,
                  fmt::format("{} bytes after the end of the picture are not read", file.content.size() - chunks.end));
}

}  // namespace

Bitmap readPngBitmap(const BitmapFile& file) {
    const PngChunks chunks = scanChunks(file);
    requirePlausibleSize(file, chunks);
    Bitmap bitmap = file.makeBitmap(chunks.width, chunks.height);
    PngDecoder decoder(file, bitmap);
    decoder.attempt([](png_structp png, png_infop info) {
        png_read_info(png, info);
        png_set_expand_16(png);  // palettes and few bits too: v becomes 257 v, so that 16 bits hold all exactly
        png_set_gray_to_rgb(png);
        png_set_strip_alpha(png);
        png_set_swap(png);
        png_set_interlace_handling(png);
        png_read_update_info(png, info);
    });
    std::vector<std::uint16_t> values(3 * bitmap.texels.size());
    std::vector<png_bytep> rows(bitmap.size.y);
    for (std::size_t y = 0; y < rows.size(); ++y)
        rows[y] = reinterpret_cast<png_bytep>(values.data() + 3 * y * bitmap.size.x);
    const std::size_t rowBytes = std::size_t(bitmap.size.x) * 3 * sizeof(std::uint16_t);
    decoder.attempt([&rows, rowBytes](png_structp png, png_infop info) {
        if (png_get_rowbytes(png, info) != rowBytes || png_get_image_height(png, info) != rows.size())
            png_error(png, "a size that its header does not say");
        png_read_image(png, rows.data());
        png_read_end(png, info);
    });
    noteMetadata(file, chunks, decoder, bitmap);  // chunks of text and EXIF may come after the picture
    for (std::size_t i = 0; i < values.size(); ++i)
        bitmap.texels[i / 3][int(i % 3)] = file.linear(float(values[i]) / 65535.0f);
    return bitmap;
}

}  // namespace parhelion
