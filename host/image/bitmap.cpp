#include "image/bitmap.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/files.h"
#include "base/memory.h"
#include "image/bitmap_file.h"
#include "image/color_space.h"

namespace parhelion {

namespace {

/// The inverse of the sRGB curve (IEC 61966-2-1), on [0, 1].
float fromSrgb(float value) { return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f); }

bool startsWith(std::span<const std::byte> content, std::string_view magic, std::size_t offset = 0) {
    const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
    return text.size() >= offset && text.substr(offset).starts_with(magic);
}

/// What a file of none of the four formats is, where its first bytes tell.
std::string nameOfOther(std::span<const std::byte> content) {
    struct Format {
        std::string_view magic;
        std::size_t offset;
        const char* name;
    };
    using namespace std::string_view_literals;
    constexpr std::array<Format, 11> kFormats{{{"II*\0"sv, 0, "a TIFF"},
                                               {"MM\0*"sv, 0, "a TIFF"},
                                               {"WEBP"sv, 8, "a WebP"},
                                               {"ftyp"sv, 4, "a HEIF or AVIF"},
                                               {"GIF8"sv, 0, "a GIF"},
                                               {"BM"sv, 0, "a BMP"},
                                               {"PF\n"sv, 0, "a PFM"},
                                               {"8BPS"sv, 0, "a Photoshop document"},
                                               {"DDS "sv, 0, "a DDS"},
                                               {"version https://git-lfs"sv, 0, "a pointer of Git LFS, not the file"},
                                               {"<"sv, 0, "a text of markup"}}};
    if (content.empty()) return "an empty file";
    for (const Format& format : kFormats)
        if (startsWith(content, format.magic, format.offset)) return format.name;
    return "one that begins as none of them does";
}

Bitmap decode(const BitmapFile& file) {
    using namespace std::string_view_literals;
    if (startsWith(file.content, "\x76\x2f\x31\x01"sv)) return readExrBitmap(file);
    if (startsWith(file.content, "\x89PNG\r\n\x1a\n"sv)) return readPngBitmap(file);
    if (startsWith(file.content, "\xff\xd8"sv)) return readJpegBitmap(file);
    if (isRadiance(file.content)) return readRadianceBitmap(file);
    file.fail("must be a whole .exr, .hdr, .png or .jpg file; got " + nameOfOther(file.content));
}

/// What the texels of a bitmap are apart from light.
struct Darkness {
    double largest = 0.0;   ///< texel
    double light = 0.0;     ///< sum of the positive ones
    double negative = 0.0;  ///< sum of the others, as a positive number
    double least = 0.0;     ///< of them
    std::size_t negatives = 0, infinities = 0;
};

Darkness darknessOf(const Bitmap& bitmap) {
    Darkness result;
    for (const glm::vec3& texel : bitmap.texels)
        for (int channel = 0; channel < 3; ++channel) {
            const double value = texel[channel];
            if (!std::isfinite(value)) {
                ++result.infinities;
            } else if (value < 0.0) {
                ++result.negatives;
                result.negative -= value;
                result.least = std::min(result.least, value);
            } else {
                result.light += value;
                result.largest = std::max(result.largest, value);
            }
        }
    return result;
}

/// @throws InputError naming the first value that isBad.
template <typename Condition>
[[noreturn]] void failAtFirst(const BitmapFile& file, const Bitmap& bitmap, const std::string& what,
                              const Condition& isBad) {
    for (std::size_t i = 0; i < bitmap.texels.size(); ++i)
        for (int channel = 0; channel < 3; ++channel)
            if (const float value = bitmap.texels[i][channel]; isBad(value))
                file.fail(fmt::format("{}; got {} in channel {} at column {}, row {}", what, value, "RGB"[channel],
                                      i % bitmap.size.x, i / bitmap.size.x));
    throw RuntimeFailure("no texel is what the count of texels says");
}

/// Texels are light: what is negligibly negative becomes 0, anything else that is none is refused.
void requireLight(const BitmapFile& file, Bitmap& bitmap) {
    const Darkness found = darknessOf(bitmap);
    if (found.infinities + found.negatives == 0) return;
    if (found.infinities > 0)
        failAtFirst(
            file, bitmap,
            fmt::format("texels must be finite and >= 0; {} values are not finite, the first", found.infinities),
            [](float value) { return !std::isfinite(value); });
    const double limit = kNegligibleTexel * found.largest;
    if (-found.least > limit)
        failAtFirst(
            file, bitmap,
            fmt::format("texels must be finite and >= 0 (or no further below 0 than 1/510 of the largest, {:.3g}); "
                        "{} values are negative, down to {:.3g}",
                        found.largest, found.negatives, found.least),
            [limit](float value) { return -value > limit; });
    if (found.negative > kNegligibleLight * found.light)
        failAtFirst(file, bitmap,
                    fmt::format("texels must be finite and >= 0 (or together no further below 0 than 1/2048 of all the "
                                "light); {} values are negative and sum up to {:.3g} of it; the first",
                                found.negatives, found.negative / found.light),
                    [](float value) { return value < 0.0f; });
    for (glm::vec3& texel : bitmap.texels)
        for (int channel = 0; channel < 3; ++channel)
            if (texel[channel] < 0.0f) texel[channel] = 0.0f;
    file.note(bitmap, fmt::format("{} negative values, down to {:.3g} ({:.1e} of the largest), are taken for 0: lossy "
                                  "compression or a filter left them",
                                  found.negatives, found.least, -found.least / found.largest));
}

}  // namespace

void BitmapFile::fail(const std::string& message, int line) const {
    throw InputError({path.string(), line, line > 0 ? 1 : 0}, message);
}

void BitmapFile::note(Bitmap& bitmap, const std::string& message, int line) const {
    bitmap.notes.push_back(SourceLocation{path.string(), line, line > 0 ? 1 : 0}.text() + ": " + message);
}

Bitmap BitmapFile::makeBitmap(std::uint64_t width, std::uint64_t height) const {
    if (width > kMaxBitmapSize || height > kMaxBitmapSize)
        fail(fmt::format("a bitmap may have at most {} texels a side; got {} x {}", kMaxBitmapSize, width, height));
    if (width < 1 || height < 1) fail(fmt::format("a bitmap must have at least one texel; got {} x {}", width, height));
    // The decoders' own buffers take at most as much again as the texels do.
    const double bytes = 2.0 * double(width) * double(height) * (sizeof(glm::vec3) + 3 * sizeof(float));
    if (bytes > static_cast<double>(physicalMemoryBytes()))
        fail(fmt::format("a bitmap must fit into half of the memory; got {} x {} texels", width, height));
    return {{unsigned(width), unsigned(height)}, std::vector<glm::vec3>(std::size_t(width) * height)};
}

float BitmapFile::linear(float value) const { return encoding == BitmapEncoding::kSrgb ? fromSrgb(value) : value; }

void convertPrimaries(const BitmapFile& file, const Chromaticities& space, Bitmap& bitmap, const std::string& name,
                      int line) {
    if (!spansColours(space)) file.fail(name + " must span colours about a white", line);
    const glm::dmat3 matrix = rec709FromRgb(space);
    if (matrix == glm::dmat3(1.0)) return;
    for (glm::vec3& texel : bitmap.texels) texel = glm::vec3(matrix * glm::dvec3(texel));
}

Bitmap readBitmap(const std::filesystem::path& file, const SourceLocation& where, BitmapEncoding encoding) {
    const std::vector<std::byte> content = readBinaryFile(file, where);
    const BitmapFile source{file, content, encoding};
    Bitmap bitmap = decode(source);
    requireLight(source, bitmap);
    return bitmap;
}

}  // namespace parhelion
