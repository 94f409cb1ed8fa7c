#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
// jpeglib.h names FILE and size_t without including what defines them.
#include <jpeglib.h>
// Its codes of warnings.
#include <jerror.h>

#include "image/bitmap_file.h"
#include "image/embedded_metadata.h"

namespace parhelion {

namespace {

constexpr int kExif = JPEG_APP0 + 1, kProfile = JPEG_APP0 + 2;
/// More scans than any encoder writes; each costs the time of a whole picture.
constexpr int kMaxScans = 500;

/// Warnings after which the pixels are what the file holds; after all others libjpeg makes pixels up.
bool isHarmless(int code) {
    constexpr std::array<int, 5> kHarmless{JWRN_EXTRANEOUS_DATA, JWRN_ADOBE_XFORM, JWRN_JFIF_MAJOR, JWRN_BOGUS_ICC,
                                           JWRN_NOT_SEQUENTIAL};
    return std::ranges::find(kHarmless, code) != kHarmless.end();
}

/// libjpeg's state. Its errors jump over C++ frames, so that what runs in attempt() must own nothing.
class JpegDecoder {
public:
    JpegDecoder(const BitmapFile& file, std::vector<std::string>& warnings) : file_(file), warnings_(warnings) {
        info_.err = jpeg_std_error(&errors_);
        errors_.error_exit = &JpegDecoder::onError;
        errors_.emit_message = &JpegDecoder::onMessage;
        info_.client_data = this;
        attempt([](jpeg_decompress_struct& info) { jpeg_create_decompress(&info); });
        info_.client_data = this;
        attempt([&file](jpeg_decompress_struct& info) {
            jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(file.content.data()), file.content.size());
            jpeg_save_markers(&info, kExif, 0xffff);
            jpeg_save_markers(&info, kProfile, 0xffff);
        });
    }
    ~JpegDecoder() { jpeg_destroy_decompress(&info_); }
    JpegDecoder(const JpegDecoder&) = delete;
    JpegDecoder& operator=(const JpegDecoder&) = delete;

    jpeg_decompress_struct& info() { return info_; }

    /// Runs part(info). @throws InputError for what libjpeg calls an error, and for warnings that tell of damage.
    template <typename Part>
    void attempt(const Part& part) {
        if (!run(part))
            file_.fail(fmt::format("must be a whole, undamaged .jpg file; libjpeg says: {}", message_.data()));
    }

private:
    template <typename Part>
    bool run(const Part& part) {
        if (setjmp(jump_)) return false;
        part(info_);
        return true;
    }

    static void onError(j_common_ptr info) {
        auto& self = *static_cast<JpegDecoder*>(info->client_data);
        info->err->format_message(info, self.message_.data());
        std::longjmp(self.jump_, 1);
    }

    static void onMessage(j_common_ptr info, int level) {
        if (level >= 0) return;  // a trace
        if (!isHarmless(info->err->msg_code)) onError(info);
        auto& self = *static_cast<JpegDecoder*>(info->client_data);
        if (self.warnings_.empty()) {
            info->err->format_message(info, self.message_.data());
            self.warnings_.push_back(self.message_.data());
        }
    }

    const BitmapFile& file_;
    std::vector<std::string>& warnings_;  ///< the first
    jpeg_error_mgr errors_{};
    jpeg_decompress_struct info_{};
    std::jmp_buf jump_{};
    std::array<char, JMSG_LENGTH_MAX> message_{};
};

/// @throws InputError for what the header alone rules out.
void requireDecodable(const BitmapFile& file, const jpeg_decompress_struct& info) {
    if (info.num_components != 1 && info.num_components != 3 && info.num_components != 4)
        file.fail(
            fmt::format("a JPEG must be grey, RGB or CMYK: of 1, 3 or 4 components; got {}", info.num_components));
    double blocks = 0.0;
    for (int i = 0; i < info.num_components; ++i)
        blocks = std::max(blocks, double(info.comp_info[i].width_in_blocks) * info.comp_info[i].height_in_blocks);
    // Huffman codes take a bit a block at least.
    if (!info.arith_code && blocks > 8.0 * double(file.content.size()))
        file.fail(fmt::format("must be a whole .jpg file; {} bytes cannot hold {} x {} texels", file.content.size(),
                              info.image_width, info.image_height));
}

void noteMarkers(const BitmapFile& file, JpegDecoder& decoder, Bitmap& bitmap) {
    const jpeg_decompress_struct& info = decoder.info();
    for (jpeg_saved_marker_ptr marker = info.marker_list; marker; marker = marker->next) {
        if (marker->marker != kExif || marker->data_length < 6 || std::memcmp(marker->data, "Exif\0", 6) != 0) continue;
        const auto orientation =
            exifOrientation(std::as_bytes(std::span(marker->data, marker->data_length).subspan(6)));
        if (orientation.value_or(1) != 1)
            file.note(bitmap, fmt::format("its EXIF orientation, {}, has no effect, as in Mitsuba", *orientation));
    }
    JOCTET* profile = nullptr;
    unsigned size = 0;
    decoder.attempt([&profile, &size](jpeg_decompress_struct& i) { jpeg_read_icc_profile(&i, &profile, &size); });
    const std::unique_ptr<JOCTET, decltype(&std::free)> owner(profile, &std::free);
    if (profile && info.num_components == 3 && file.encoding == BitmapEncoding::kSrgb &&
        !namesSrgb(std::as_bytes(std::span(profile, size))))
        file.note(bitmap, "its colour profile has no effect: colours are taken for sRGB, as in Mitsuba");
    if (info.arith_code)
        file.note(bitmap, "whether its arithmetic-coded picture is whole cannot be told: such codes go on without end");
    if (info.num_components == 4)
        file.note(bitmap, "inks (CMYK) are multiplied to red, green and blue; a colour profile has no effect");
}

/// Components that scans have brought so far, a bit each.
using Components = unsigned;

Components componentsOf(const jpeg_decompress_struct& info) {
    Components result = 0;
    for (int i = 0; i < info.comps_in_scan; ++i) result |= 1u << info.cur_comp_info[i]->component_index;
    return result;
}

/// Reads every scan of a picture that has several into memory; returns the components that had one.
Components readScans(const BitmapFile& file, JpegDecoder& decoder) {
    Components found = 0;
    decoder.attempt([&found](jpeg_decompress_struct& info) {
        found = componentsOf(info);
        info.buffered_image = TRUE;
        info.do_block_smoothing = FALSE;
        jpeg_start_decompress(&info);
        for (int status = 0; status != JPEG_REACHED_EOI && info.input_scan_number <= kMaxScans;) {
            status = jpeg_consume_input(&info);
            if (status == JPEG_REACHED_SOS) found |= componentsOf(info);
        }
    });
    if (decoder.info().input_scan_number > kMaxScans)
        file.fail(fmt::format("a JPEG may have at most {} scans; got more", kMaxScans));
    decoder.attempt([](jpeg_decompress_struct& info) { jpeg_start_output(&info, info.input_scan_number); });
    return found;
}

/// Starts the output of rows: R, G, B or C, M, Y, K.
void start(const BitmapFile& file, JpegDecoder& decoder) {
    jpeg_decompress_struct& info = decoder.info();
    info.out_color_space = info.num_components == 4 ? JCS_CMYK : JCS_RGB;
    info.dct_method = JDCT_ISLOW;
    if (!jpeg_has_multiple_scans(&info)) {
        decoder.attempt([](jpeg_decompress_struct& i) { jpeg_start_decompress(&i); });
        return;
    }
    if (readScans(file, decoder) != (1u << info.num_components) - 1)
        file.fail("must be a whole .jpg file; some of its components have no scan");
}

/// a * b / 255, rounded, of values up to 255.
std::uint8_t product(unsigned a, unsigned b) {
    const unsigned t = a * b + 128;
    return std::uint8_t((t + (t >> 8)) >> 8);
}

/// A row's texels. Adobe's programs, which leave a marker, write inks as what they leave of the light.
void convertRow(const BitmapFile& file, const jpeg_decompress_struct& info, std::span<const JSAMPLE> row,
                std::span<glm::vec3> texels) {
    const unsigned flip = info.num_components == 4 && !info.saw_Adobe_marker ? 255 : 0;
    for (std::size_t x = 0; x < texels.size(); ++x)
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const std::uint8_t value = info.num_components == 4
                                           ? product(row[4 * x + channel] ^ flip, row[4 * x + 3] ^ flip)
                                           : row[3 * x + channel];
            texels[x][int(channel)] = file.linear(float(value) / 255.0f);
        }
}

}  // namespace

Bitmap readJpegBitmap(const BitmapFile& file) {
    std::vector<std::string> warnings;
    JpegDecoder decoder(file, warnings);
    jpeg_decompress_struct& info = decoder.info();
    decoder.attempt([](jpeg_decompress_struct& i) { jpeg_read_header(&i, TRUE); });
    requireDecodable(file, info);
    Bitmap bitmap = file.makeBitmap(info.image_width, info.image_height);
    noteMarkers(file, decoder, bitmap);
    start(file, decoder);
    std::vector<JSAMPLE> row(std::size_t(info.output_width) * std::size_t(info.output_components));
    for (std::size_t y = 0; y < bitmap.size.y; ++y) {
        decoder.attempt([&row](jpeg_decompress_struct& i) {
            JSAMPROW target = row.data();
            jpeg_read_scanlines(&i, &target, 1);
        });
        convertRow(file, info, row, std::span(bitmap.texels).subspan(y * bitmap.size.x, bitmap.size.x));
    }
    decoder.attempt([](jpeg_decompress_struct& i) {
        if (i.buffered_image) jpeg_finish_output(&i);
        jpeg_finish_decompress(&i);
    });
    for (const std::string& warning : warnings) file.note(bitmap, fmt::format("libjpeg warns: {}", warning));
    if (const std::size_t left = info.src->bytes_in_buffer; left > 0)
        file.note(
            bitmap,
            fmt::format("{} bytes after the end of the picture are not read (motion photos keep a film there)", left));
    return bitmap;
}

}  // namespace parhelion
