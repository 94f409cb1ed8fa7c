#include "image/bitmap.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <string_view>

#include "base/files.h"
#include "base/memory.h"
#include "image/color_space.h"
#include "image/image.h"

#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS int(parhelion::kMaxBitmapSize)
#include <stb/stb_image.h>

namespace parhelion {

namespace {

bool isExr(const std::vector<std::byte>& content) {
    constexpr std::array<unsigned char, 4> kMagic{0x76, 0x2f, 0x31, 0x01};
    return content.size() >= kMagic.size() && std::memcmp(content.data(), kMagic.data(), kMagic.size()) == 0;
}

void requireDimensions(const std::filesystem::path& file, glm::uvec2 size) {
    if (size.x > kMaxBitmapSize || size.y > kMaxBitmapSize)
        throw InputError({file.string()}, fmt::format("a bitmap may have at most {} texels a side; got {} x {}",
                                                      kMaxBitmapSize, size.x, size.y));
}

/// The channels that hold the colours, in the order in which they are looked for, as in Mitsuba.
/// @throws InputError if there are none.
std::array<std::string, 3> colourChannels(const std::filesystem::path& file, const Image& image) {
    using Channels = std::array<std::string, 3>;
    for (const Channels& channels : {Channels{"R", "G", "B"}, Channels{"X", "Y", "Z"}, Channels{"Y", "RY", "BY"}})
        if (std::ranges::all_of(channels, [&image](const std::string& name) { return image.has(name); }))
            return channels;
    if (image.has("Y")) return {"Y", "Y", "Y"};
    throw InputError({file.string()},
                     "an EXR bitmap must have the channels R, G and B; X, Y and Z; Y, RY and BY; or Y");
}

/// Turns R, G and B of the file's primaries into Rec. 709.
void convertPrimaries(const std::filesystem::path& file, const Chromaticities& space, Bitmap& bitmap) {
    const glm::dmat3 matrix = rec709FromRgb(space);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!std::isfinite(matrix[column][row]))
                throw InputError({file.string()}, "\"chromaticities\" must span colours about a white");
    if (matrix == glm::dmat3(1.0)) return;
    for (glm::vec3& texel : bitmap.texels) texel = glm::vec3(matrix * glm::dvec3(texel));
}

Bitmap fromExr(const std::filesystem::path& file) {
    const Image image = readExr(file);
    requireDimensions(file, image.size);
    const std::array<std::string, 3> names = colourChannels(file, image);
    Bitmap bitmap{image.size, std::vector<glm::vec3>(std::size_t(image.size.x) * image.size.y)};
    for (int channel = 0; channel < 3; ++channel) {
        const std::vector<float>& values = image.channels.at(names[std::size_t(channel)]);
        for (std::size_t i = 0; i < values.size(); ++i) bitmap.texels[i][channel] = values[i];
    }
    const Chromaticities space = image.chromaticities.value_or(kRec709);
    if (names[0] == "X")
        for (glm::vec3& texel : bitmap.texels) texel = glm::vec3(kRec709FromXyz * glm::dvec3(texel));
    if (names[1] == "RY")
        for (glm::vec3& texel : bitmap.texels) texel = glm::vec3(rgbFromChroma(texel.x, texel.y, texel.z, space));
    if (names[0] == "R" || names[1] == "RY") convertPrimaries(file, space, bitmap);
    return bitmap;
}

/// The inverse of the sRGB curve (IEC 61966-2-1), on [0, 1].
float fromSrgb(float value) { return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f); }

/// @throws InputError before a damaged header makes the decoder ask for what the machine has not.
void requireSize(const std::filesystem::path& file, int width, int height) {
    requireDimensions(file, {unsigned(std::max(width, 0)), unsigned(std::max(height, 0))});
    if (width < 1 || height < 1)
        throw InputError({file.string()},
                         fmt::format("a bitmap must have at least one texel; got {} x {}", width, height));
    const double bytes = 2.0 * width * height * (sizeof(glm::vec3) + 3 * sizeof(float));
    if (bytes > static_cast<double>(physicalMemoryBytes()))
        throw InputError({file.string()},
                         fmt::format("a bitmap must fit into half of the memory; got {} x {} texels", width, height));
}

/// stb_image fills what a cut JPEG lacks: a whole one has its end marker after the last start of a scan.
bool isCutJpeg(const std::vector<std::byte>& content) {
    const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
    if (!text.starts_with("\xff\xd8")) return false;
    const std::size_t scan = text.rfind("\xff\xda");
    return scan == std::string_view::npos || text.find("\xff\xd9", scan) == std::string_view::npos;
}

/// Bytes for stb_image, which takes what lies beyond the end of an HDR file for zeros, and a run of length zero for no
/// reason to stop: line feeds follow the end here, which it does come to an end with.
struct ByteSource {
    const std::vector<std::byte>& content;
    std::size_t at = 0;
    bool isExhausted = false;  ///< more was asked for than there is

    static int read(void* source, char* target, int size) {
        constexpr int kBuffer = 128;  // stb_image's, which it fills as far as it can; all else it needs in full
        auto& self = *static_cast<ByteSource*>(source);
        const std::size_t count = std::min(std::size_t(size), self.content.size() - self.at);
        std::memcpy(target, self.content.data() + self.at, count);
        self.at += count;
        if (int(count) == size || (count > 0 && size == kBuffer)) return int(count);
        self.isExhausted = true;
        std::memset(target + count, '\n', std::size_t(size) - count);
        return size;
    }
    static void skip(void* source, int count) {
        auto& self = *static_cast<ByteSource*>(source);
        self.at = std::min(self.at + std::size_t(std::max(count, 0)), self.content.size());
    }
    static int isAtEnd(void* source) {
        const auto& self = *static_cast<ByteSource*>(source);
        return self.at >= self.content.size();
    }
};

/// Colours of a Radiance HDR file, 3 a texel; null if it is damaged or cut.
std::unique_ptr<float, decltype(&std::free)> decodeHdr(const std::vector<std::byte>& content) {
    ByteSource source{content};
    const stbi_io_callbacks callbacks{&ByteSource::read, &ByteSource::skip, &ByteSource::isAtEnd};
    int width = 0, height = 0, channels = 0;
    float* values = stbi_loadf_from_callbacks(&callbacks, &source, &width, &height, &channels, 3);
    std::unique_ptr<float, decltype(&std::free)> result(values, &std::free);
    if (source.isExhausted) result.reset();
    return result;
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
    if (isCutJpeg(content)) throw InputError({file.string()}, "must be a whole .jpg file; got one without its end");
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(bytes, length, &width, &height, &channels)) fail();
    requireSize(file, width, height);
    Bitmap bitmap{{unsigned(width), unsigned(height)}, std::vector<glm::vec3>(std::size_t(width) * height)};
    if (stbi_is_hdr_from_memory(bytes, length)) {
        const auto values = decodeHdr(content);
        if (!values) throw InputError({file.string()}, "must be a whole .hdr file; got one that is damaged or cut");
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
