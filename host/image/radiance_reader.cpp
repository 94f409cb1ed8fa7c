#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "image/color_space.h"
#include "image/radiance_header.h"

namespace parhelion {

namespace {

/// Three mantissas and their exponent, excess 128.
using Pixel = std::array<std::uint8_t, 4>;

/// The lengths of scanlines that may have each component run-length coded apart.
constexpr std::size_t kMinCoded = 8, kMaxCoded = 0x7fff;

/// A value is mantissa / 256 * 2^(exponent - 128), black where the exponent is 0. Radiance itself adds half a step to
/// the mantissa; Mitsuba and most other programs do not, so that 1 is 1.
glm::vec3 valueOf(const Pixel& pixel) {
    if (pixel[3] == 0) return glm::vec3(0.0f);
    const float step = std::ldexp(1.0f, int(pixel[3]) - (128 + 8));
    return step * glm::vec3(pixel[0], pixel[1], pixel[2]);
}

/// Reads the scanlines, one after another. Source: Radiance's file formats, "Picture Format"; G. Ward, "Real Pixels",
/// Graphics Gems II.
class ScanlineReader {
public:
    ScanlineReader(const BitmapFile& file, const RadianceHeader& header)
        : file_(file), at_(header.begin), lines_(header.scanlines.size) {}

    void read(std::span<Pixel> line) {
        if (isCoded(line.size()))
            readComponents(line);
        else
            readPixels(line);
        ++line_;
    }

    std::size_t bytesLeft() const { return file_.content.size() - at_; }

private:
    [[noreturn]] void fail(const std::string& what) const {
        file_.fail(fmt::format("must be a whole, undamaged .hdr file; scanline {} of {} {} at byte {} of {}", line_ + 1,
                               lines_, what, at_, file_.content.size()));
    }

    std::uint8_t next() {
        if (at_ == file_.content.size()) fail("is cut off");
        return file_.byte(at_++);
    }

    /// Coded scanlines begin with 2, 2 and their length, which no flat pixel does: one of its mantissas is >= 128.
    bool isCoded(std::size_t length) const {
        return length >= kMinCoded && length <= kMaxCoded && bytesLeft() >= 4 && file_.byte(at_) == 2 &&
               file_.byte(at_ + 1) == 2 && file_.byte(at_ + 2) < 128;
    }

    /// The newer coding: each component in runs (128 + length, value) and pieces (length, values).
    void readComponents(std::span<Pixel> line) {
        const std::size_t stated = 256u * file_.byte(at_ + 2) + file_.byte(at_ + 3);
        if (stated != line.size()) fail(fmt::format("says that it has {} pixels, not {},", stated, line.size()));
        at_ += 4;
        for (std::size_t component = 0; component < 4; ++component)
            for (std::size_t i = 0; i < line.size();) {
                const std::size_t code = next();
                const bool isRun = code > 128;
                const std::size_t length = isRun ? code - 128 : code;
                if (length == 0 || length > line.size() - i)
                    fail(fmt::format("has {} values of a component where {} are left", length, line.size() - i));
                const std::uint8_t value = isRun ? next() : 0;
                for (const std::size_t end = i + length; i < end; ++i) line[i][component] = isRun ? value : next();
            }
    }

    /// Whole pixels: flat, or in the older coding, where 1, 1, 1, n repeats the last pixel n times, and those that
    /// follow it at once n * 256, n * 65536, ... times.
    void readPixels(std::span<Pixel> line) {
        unsigned shift = 0;
        for (std::size_t i = 0; i < line.size();) {
            const Pixel pixel{next(), next(), next(), next()};
            if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
                line[i++] = pixel;
                shift = 0;
                continue;
            }
            const std::uint64_t count = std::uint64_t{pixel[3]} << std::min(shift, 32u);
            if (i == 0) fail("begins with a run, which repeats nothing,");
            if (count > line.size() - i)
                fail(fmt::format("has a run of {} pixels where {} are left", count, line.size() - i));
            std::fill_n(line.begin() + std::ptrdiff_t(i), count, line[i - 1]);
            i += count;
            shift += 8;
        }
    }

    const BitmapFile& file_;
    std::size_t at_;
    std::size_t line_ = 0, lines_;
};

/// Where an axis' n-th pixel lies, counted from the left, or from the top.
std::size_t positionOf(const RadianceHeader::Axis& axis, std::size_t n) {
    const bool fromEnd = axis.isY ? !axis.decreases : axis.decreases;
    return fromEnd ? axis.size - 1 - n : n;
}

void toRec709(const BitmapFile& file, const RadianceHeader& header, Bitmap& bitmap) {
    if (header.divisor != glm::dvec3(1.0))
        for (glm::vec3& texel : bitmap.texels) texel = glm::vec3(glm::dvec3(texel) / header.divisor);
    if (header.isXyz)
        for (glm::vec3& texel : bitmap.texels) texel = glm::vec3(kRec709FromXyz * glm::dvec3(texel));
    if (header.space) convertPrimaries(file, *header.space, bitmap, "PRIMARIES", header.spaceLine);
}

}  // namespace

Bitmap readRadianceBitmap(const BitmapFile& file) {
    Bitmap remarks;
    const RadianceHeader header = readRadianceHeader(file, remarks);
    const auto [width, height] = std::array{header.size().x, header.size().y};
    // Every scanline takes a pixel at least: a cut file is told apart from a huge one before there is room for either.
    const double needed = 4.0 * double(std::min<std::uint64_t>(header.scanlines.size, kMaxBitmapSize));
    if (width > 0 && needed > double(file.content.size() - header.begin) && std::max(width, height) <= kMaxBitmapSize)
        file.fail(fmt::format("must be a whole .hdr file; {} bytes cannot hold its {} scanlines",
                              file.content.size() - header.begin, header.scanlines.size));
    Bitmap bitmap = file.makeBitmap(width, height);
    bitmap.notes = std::move(remarks.notes);
    ScanlineReader reader(file, header);
    std::vector<Pixel> line(header.pixels.size);
    for (std::size_t i = 0; i < header.scanlines.size; ++i) {
        reader.read(line);
        for (std::size_t j = 0; j < line.size(); ++j) {
            const std::size_t a = positionOf(header.scanlines, i), b = positionOf(header.pixels, j);
            bitmap.texels[header.scanlines.isY ? a * width + b : b * width + a] = valueOf(line[j]);
        }
    }
    if (reader.bytesLeft() > 0)
        file.note(bitmap, fmt::format("{} bytes after the last scanline are not read", reader.bytesLeft()));
    toRec709(file, header, bitmap);
    return bitmap;
}

}  // namespace parhelion
