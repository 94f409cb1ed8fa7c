#include "image/bitmap.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>

#include "base/files.h"
#include "base/memory.h"
#include "image/image.h"

#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 65536
#include <stb/stb_image.h>

namespace parhelion {

namespace {

bool isExr(const std::vector<std::byte>& content) {
    constexpr std::array<unsigned char, 4> kMagic{0x76, 0x2f, 0x31, 0x01};
    return content.size() >= kMagic.size() && std::memcmp(content.data(), kMagic.data(), kMagic.size()) == 0;
}

Bitmap fromExr(const std::filesystem::path& file) {
    const Image image = readExr(file);
    const std::array<std::string, 3> colour{"R", "G", "B"};
    const bool isColour = image.has("R") && image.has("G") && image.has("B");
    if (!isColour && !image.has("Y"))
        throw InputError({file.string()}, "an EXR bitmap must have the channels R, G and B, or Y");
    Bitmap bitmap{image.size, std::vector<glm::vec3>(std::size_t(image.size.x) * image.size.y)};
    for (int channel = 0; channel < 3; ++channel) {
        const std::vector<float>& values = image.channels.at(isColour ? colour[channel] : "Y");
        for (std::size_t i = 0; i < values.size(); ++i) bitmap.texels[i][channel] = values[i];
    }
    return bitmap;
}

/// The inverse of the sRGB curve (IEC 61966-2-1), on [0, 1].
float fromSrgb(float value) { return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f); }

/// @throws InputError before a damaged header makes the decoder ask for what the machine has not.
void requireSize(const std::filesystem::path& file, int width, int height) {
    const double bytes = 2.0 * width * height * (sizeof(glm::vec3) + 3 * sizeof(float));
    if (bytes > static_cast<double>(physicalMemoryBytes()))
        throw InputError({file.string()},
                         fmt::format("a bitmap must fit into half of the memory; got {} x {} texels", width, height));
}

Bitmap fromStb(const std::filesystem::path& file, const std::vector<std::byte>& content, BitmapEncoding encoding) {
    const auto* bytes = reinterpret_cast<const stbi_uc*>(content.data());
    const int length = static_cast<int>(content.size());
    const auto fail = [&] {
        throw InputError({file.string()},
                         fmt::format("must be a whole .exr, .hdr, .png or .jpg file; got one that fails "
                                     "with: {}",
                                     stbi_failure_reason()));
    };
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(bytes, length, &width, &height, &channels)) fail();
    requireSize(file, width, height);
    Bitmap bitmap{{unsigned(width), unsigned(height)}, std::vector<glm::vec3>(std::size_t(width) * height)};
    if (stbi_is_hdr_from_memory(bytes, length)) {
        const std::unique_ptr<float, decltype(&std::free)> values(
            stbi_loadf_from_memory(bytes, length, &width, &height, &channels, 3), &std::free);
        if (!values) fail();
        std::memcpy(bitmap.texels.data(), values.get(), bitmap.texels.size() * sizeof(glm::vec3));
        return bitmap;
    }
    // 16 bits hold 8 exactly: v * 257.
    const std::unique_ptr<stbi_us, decltype(&std::free)> values(
        stbi_load_16_from_memory(bytes, length, &width, &height, &channels, 3), &std::free);
    if (!values) fail();
    for (std::size_t i = 0; i < bitmap.texels.size(); ++i)
        for (int channel = 0; channel < 3; ++channel) {
            const float value = float(values.get()[3 * i + channel]) / 65535.0f;
            bitmap.texels[i][channel] = encoding == BitmapEncoding::kSrgb ? fromSrgb(value) : value;
        }
    return bitmap;
}

void requireLight(const std::filesystem::path& file, const Bitmap& bitmap) {
    for (std::size_t i = 0; i < bitmap.texels.size(); ++i)
        for (int channel = 0; channel < 3; ++channel)
            if (const float value = bitmap.texels[i][channel]; !(std::isfinite(value) && value >= 0.0f))
                throw InputError(
                    {file.string()},
                    fmt::format("texels must be finite and >= 0; got {} in channel {} at column {}, row {}", value,
                                "RGB"[channel], i % bitmap.size.x, i / bitmap.size.x));
}

}  // namespace

Bitmap readBitmap(const std::filesystem::path& file, const SourceLocation& where, BitmapEncoding encoding) {
    const std::vector<std::byte> content = readBinaryFile(file, where);
    if (content.size() > 0x7fffffffu)
        throw InputError({file.string()},
                         fmt::format("a bitmap file must be below 2 GiB; got {} bytes", content.size()));
    Bitmap bitmap = isExr(content) ? fromExr(file) : fromStb(file, content, encoding);
    requireLight(file, bitmap);
    return bitmap;
}

}  // namespace parhelion
