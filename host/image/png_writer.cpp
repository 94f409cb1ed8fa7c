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

}  // namespace

void writePng(const std::filesystem::path& file, const Image& image, double exposureStops) {
    if (!(std::abs(exposureStops) <= kMaxExposureStops))
        throw InputError(
            fmt::format("exposure must be in [-{0}, {0}] stops; got {1}", kMaxExposureStops, exposureStops));
    // The encoder counts bytes in an int.
    if ((3.0 * image.size.x + 1) * image.size.y > std::numeric_limits<int>::max())
        throw InputError(
            fmt::format("a PNG must have fewer than 2^31 bytes; got {} x {} pixels", image.size.x, image.size.y));
    const std::vector<std::uint8_t> pixels = displayBytes(image, exposureStops);
    std::vector<std::byte> content;
    const int width = static_cast<int>(image.size.x), height = static_cast<int>(image.size.y);
    if (stbi_write_png_to_func(appendBytes, &content, width, height, 3, pixels.data(), 3 * width) == 0)
        throw RuntimeFailure(fmt::format("cannot encode '{}' as PNG", file.string()));
    writeAtomically(file, content);
}

}  // namespace parhelion
