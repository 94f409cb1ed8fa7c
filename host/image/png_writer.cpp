#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <fmt/format.h>
#include <stb/stb_image_write.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

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

void appendBytes(void* target, void* data, int size) {
    const auto* bytes = static_cast<const std::byte*>(data);
    static_cast<std::vector<std::byte>*>(target)->insert(static_cast<std::vector<std::byte>*>(target)->end(), bytes,
                                                         bytes + size);
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

void encodePng(const std::filesystem::path& file, glm::uvec2 size, const std::vector<std::uint8_t>& pixels) {
    // The encoder counts bytes in an int.
    if ((3.0 * size.x + 1) * size.y > std::numeric_limits<int>::max())
        throw InputError(fmt::format("a PNG must have fewer than 2^31 bytes; got {} x {} pixels", size.x, size.y));
    std::vector<std::byte> content;
    const int width = static_cast<int>(size.x), height = static_cast<int>(size.y);
    if (stbi_write_png_to_func(appendBytes, &content, width, height, 3, pixels.data(), 3 * width) == 0)
        throw RuntimeFailure(fmt::format("cannot encode '{}' as PNG", file.string()));
    writeAtomically(file, content);
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
