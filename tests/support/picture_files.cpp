#include "support/picture_files.h"

#include <zlib.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
// jpeglib.h names FILE and size_t without including what defines them.
#include <jpeglib.h>

namespace parhelion::test {

namespace {

std::string bigEndian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += char(value >> shift & 0xff);
    return bytes;
}

/// Every `step`-th sample of the rows, packed from the highest bit on, each row behind the number of its filter, 0.
std::string packedRows(const PngPicture& p, unsigned left, unsigned top, unsigned stepX, unsigned stepY) {
    std::string bytes;
    for (unsigned y = top; left < p.width && y < p.height; y += stepY) {
        bytes += '\0';
        unsigned pending = 0, bits = 0;
        for (unsigned x = left; x < p.width; x += stepX)
            for (unsigned channel = 0; channel < p.channels(); ++channel) {
                const unsigned sample = p.samples.at((std::size_t(y) * p.width + x) * p.channels() + channel);
                pending = pending << p.bits | sample;
                bits += p.bits;
                for (; bits >= 8; bits -= 8) bytes += char(pending >> (bits - 8) & 0xff);
            }
        if (bits > 0) bytes += char(pending << (8 - bits) & 0xff);
    }
    return bytes;
}

[[noreturn]] void throwMessage(j_common_ptr info) {
    std::array<char, JMSG_LENGTH_MAX> message{};
    info->err->format_message(info, message.data());
    throw std::runtime_error(message.data());
}

void setColours(const JpegPicture& picture, jpeg_compress_struct& info) {
    using Colours = JpegPicture::Colours;
    const bool isInk = picture.colours == Colours::kInks || picture.colours == Colours::kAdobeInks;
    info.input_components = int(picture.channels());
    info.in_color_space = isInk                               ? JCS_CMYK
                          : picture.colours == Colours::kGrey ? JCS_GRAYSCALE
                          : picture.colours == Colours::kRgb  ? JCS_RGB
                                                              : JCS_UNKNOWN;
    jpeg_set_defaults(&info);
    if (picture.colours == Colours::kAdobeInks) jpeg_set_colorspace(&info, JCS_YCCK);
    info.write_Adobe_marker = picture.colours == Colours::kAdobeInks;
    jpeg_set_quality(&info, 100, TRUE);
    for (int i = 0; i < info.num_components; ++i) info.comp_info[i].h_samp_factor = info.comp_info[i].v_samp_factor = 1;
}

}  // namespace

std::string deflated(const std::string& bytes) {
    uLongf size = compressBound(bytes.size());
    std::string result(size, '\0');
    compress(reinterpret_cast<Bytef*>(result.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
             bytes.size());
    return result.substr(0, size);
}

std::string pngChunk(const std::string& type, const std::string& content) {
    const std::string checked = type + content;
    const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(checked.data()), uInt(checked.size()));
    return bigEndian(std::uint32_t(content.size())) + checked + bigEndian(std::uint32_t(sum));
}

std::string pngFile(const PngPicture& p) {
    const std::string header = bigEndian(p.width) + bigEndian(p.height) + char(p.bits) + char(p.colorType) +
                               std::string(2, '\0') + char(p.isInterlaced);
    // Adam7: left, top, and the steps of its seven passes.
    constexpr std::array<std::array<unsigned, 4>, 7> kPasses{
        {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4}, {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}}};
    std::string rows;
    if (!p.isInterlaced) rows = packedRows(p, 0, 0, 1, 1);
    for (std::size_t i = 0; p.isInterlaced && i < kPasses.size(); ++i)
        rows += packedRows(p, kPasses[i][0], kPasses[i][1], kPasses[i][2], kPasses[i][3]);
    return "\x89PNG\r\n\x1a\n" + pngChunk("IHDR", header) + p.chunks + pngChunk("IDAT", deflated(rows)) +
           pngChunk("IEND", "");
}

std::string jpegFile(const JpegPicture& picture) {
    jpeg_compress_struct info{};
    jpeg_error_mgr errors{};
    info.err = jpeg_std_error(&errors);
    errors.error_exit = &throwMessage;
    jpeg_create_compress(&info);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&info, &bytes, &size);
    info.image_width = picture.width;
    info.image_height = picture.height;
    setColours(picture, info);
    if (picture.isProgressive) jpeg_simple_progression(&info);
    info.arith_code = picture.isArithmetic;
    std::vector<jpeg_scan_info> scans;
    for (int i = 0; picture.hasScanPerComponent && i < info.num_components; ++i)
        scans.push_back({1, {i}, 0, DCTSIZE2 - 1, 0, 0});
    if (!scans.empty()) info.scan_info = scans.data();
    info.num_scans = scans.empty() ? info.num_scans : int(scans.size());
    jpeg_start_compress(&info, TRUE);
    for (const auto& [number, content] : picture.markers)
        jpeg_write_marker(&info, JPEG_APP0 + number, reinterpret_cast<const JOCTET*>(content.data()),
                          unsigned(content.size()));
    std::vector<std::uint8_t> samples = picture.samples;
    for (unsigned y = 0; y < picture.height; ++y) {
        JSAMPROW row = samples.data() + std::size_t(y) * picture.width * picture.channels();
        jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    const std::unique_ptr<unsigned char, decltype(&std::free)> owner(bytes, &std::free);
    return {reinterpret_cast<const char*>(bytes), size};
}

std::string exifData(unsigned orientation, bool isBigEndian) {
    const auto number = [isBigEndian](unsigned value, int bytes) {
        std::string text;
        for (int i = 0; i < bytes; ++i) text += char(value >> 8 * (isBigEndian ? bytes - 1 - i : i) & 0xff);
        return text;
    };
    // Byte order, 42, where the directory is; two entries: the camera's maker, and the orientation as a short.
    return (isBigEndian ? "MM" : "II") + number(42, 2) + number(8, 4) + number(2, 2) +       //
           number(0x010f, 2) + number(2, 2) + number(4, 4) + "abc" + std::string(1, '\0') +  //
           number(0x0112, 2) + number(3, 2) + number(1, 4) + number(orientation, 2) + number(0, 2) + number(0, 4);
}

}  // namespace parhelion::test
