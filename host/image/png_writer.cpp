#include <fmt/format.h>
#include <png.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/files.h"
#include "image/image.h"
#include "image/tone_curve.h"

namespace parhelion {

namespace {

constexpr double kMaxExposureStops = 64;

std::uint8_t encode(double linear) { return static_cast<std::uint8_t>(std::lround(255 * encodeSrgb(linear))); }

std::array<const std::vector<float>*, 3> colourChannels(const Image& image) {
    std::array<const std::vector<float>*, 3> channels{};
    for (int c = 0; c < 3; ++c) {
        const std::string name(1, "RGB"[c]);
        if (!image.has(name))
            throw InputError(fmt::format("a PNG needs channels R, G and B; the image has no '{}'", name));
        channels[c] = &image.channels.at(name);
    }
    return channels;
}

std::vector<std::uint8_t> displayBytes(const Image& image, double exposureStops) {
    const auto channels = colourChannels(image);
    const double exposure = std::exp2(exposureStops);
    const std::size_t count = std::size_t{image.size.x} * image.size.y;
    std::vector<std::uint8_t> bytes(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 radiance{(*channels[0])[i], (*channels[1])[i], (*channels[2])[i]};
        const glm::dvec3 shown = displayColour(exposure * radiance);
        for (int c = 0; c < 3; ++c) bytes[3 * i + c] = encode(shown[c]);
    }
    return bytes;
}

/// From blue over white to red, for x in [-1, 1].
std::array<std::uint8_t, 3> divergingColour(double x) {
    if (std::isnan(x)) return {0, 160, 0};
    constexpr std::array<glm::dvec3, 2> kEnds{glm::dvec3(33, 102, 172), glm::dvec3(178, 24, 43)};  // ColorBrewer RdBu
    const double share = std::min(std::abs(x), 1.0);
    const glm::dvec3 colour = glm::mix(glm::dvec3(255), kEnds[x > 0], share);
    return {std::uint8_t(std::lround(colour.r)), std::uint8_t(std::lround(colour.g)),
            std::uint8_t(std::lround(colour.b))};
}

/// libpng's state for one file; its errors jump back to encode(), whose part must own nothing.
class PngEncoder {
public:
    PngEncoder() {
        png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, &PngEncoder::onError, nullptr);
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
        if (!info_) throw RuntimeFailure("libpng: out of memory");
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        png_set_write_fn(png_, &content_, &PngEncoder::onWrite, nullptr);
    }
    ~PngEncoder() { png_destroy_write_struct(&png_, &info_); }
    PngEncoder(const PngEncoder&) = delete;
    PngEncoder& operator=(const PngEncoder&) = delete;

    /// An 8-bit sRGB file. @throws RuntimeFailure with what libpng says.
    const std::vector<std::byte>& encode(glm::uvec2 size, const std::vector<std::uint8_t>& pixels) {
        if (!tryEncode(size, pixels.data()))
            throw RuntimeFailure(fmt::format("cannot encode a PNG: {}", message_.data()));
        return content_;
    }

private:
    bool tryEncode(glm::uvec2 size, const std::uint8_t* pixels) {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_set_IHDR(png_, info_, size.x, size.y, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE,
                     PNG_FILTER_TYPE_BASE);
        png_set_sRGB(png_, info_, PNG_sRGB_INTENT_RELATIVE);
        png_write_info(png_, info_);
        for (std::size_t y = 0; y < size.y; ++y) png_write_row(png_, pixels + 3 * y * size.x);
        png_write_end(png_, info_);
        return true;
    }

    static void onError(png_structp png, png_const_charp message) {
        auto& self = *static_cast<PngEncoder*>(png_get_error_ptr(png));
        std::strncpy(self.message_.data(), message, self.message_.size() - 1);
        png_longjmp(png, 1);
    }

    static void onWrite(png_structp png, png_bytep data, std::size_t size) {
        auto& content = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
        const auto* bytes = reinterpret_cast<const std::byte*>(data);
        content.insert(content.end(), bytes, bytes + size);
    }

    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::vector<std::byte> content_;
    std::array<char, 256> message_{};
};

void encodePng(const std::filesystem::path& file, glm::uvec2 size, const std::vector<std::uint8_t>& pixels) {
    PngEncoder encoder;
    writeAtomically(file, encoder.encode(size, pixels));
}

}  // namespace

void writeSignedPng(const std::filesystem::path& file, glm::uvec2 size, std::span<const float> values, double range) {
    std::vector<std::uint8_t> pixels;
    pixels.reserve(3 * values.size());
    for (const float value : values)
        for (const std::uint8_t byte : divergingColour(value / range)) pixels.push_back(byte);
    encodePng(file, size, pixels);
}

void writePng(const std::filesystem::path& file, const Image& image, double exposureStops) {
    if (!(std::abs(exposureStops) <= kMaxExposureStops))
        throw InputError(
            fmt::format("exposure must be in [-{0}, {0}] stops; got {1}", kMaxExposureStops, exposureStops));
    const std::vector<std::uint8_t> pixels = displayBytes(image, exposureStops);
    encodePng(file, image.size, pixels);
}

}  // namespace parhelion
