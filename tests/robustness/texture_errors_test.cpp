// Textures that are missing, damaged, of odd sizes or hold no light: refused with their place, or read as what they
// are.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "compile/compile_scene.h"
#include "image/image.h"
#include "reference/surface/texture.h"
#include "support/bad_text.h"
#include "support/picture_files.h"

namespace parhelion::test {
namespace {

std::string textureOf(const std::string& content, const std::string& plugin = "bitmap") {
    return diffuseOf("<texture type=\"" + plugin + "\" name=\"reflectance\">" + content + "</texture>");
}

const std::string kHdrHead = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
const std::string kPair = kHdrHead + "-Y 1 +X 2\n" + std::string("\x80\x40\x20\x80\x10\x20\x40\x80", 8);

std::vector<BadText> badTextures() {
    return {
        {"NoFilename", diffuseOf("@@<texture type=\"bitmap\" name=\"reflectance\"/>"), {"filename"}},
        {"MissingFile", textureOf("<string name=\"filename\" value=\"@@no.exr\"/>"), {"no.exr", "not found"}},
        {"UnknownFilter",
         textureOf("<string name=\"filter_type\" value=\"@@trilinear\"/>"),
         {"filter_type", "bilinear, nearest"}},
        {"UnknownWrap", textureOf("<string name=\"wrap_mode\" value=\"@@zero\"/>"), {"repeat, mirror, clamp"}},
        {"UnknownFormat", textureOf("<string name=\"format\" value=\"@@half\"/>"), {"format", "float16"}},
        {"UnknownProperty",
         textureOf("<string name=\"filename\" value=\"a.hdr\"/>@@<float name=\"gamma\" value=\"1\"/>"),
         {"gamma"},
         {{"a.hdr", kPair}}},
        {"UnknownPlugin",
         diffuseOf("<texture type=\"@@chekerboard\" name=\"reflectance\"/>"),
         {"did you mean \"checkerboard\"?"}},
        {"NestedTexture",
         textureOf("@@<texture type=\"checkerboard\" name=\"color0\"/>", "checkerboard"),
         {"color0", "textures within textures"}},
        {"NegativeChecker", textureOf("<rgb name=\"color1\" value=\"@@0 -1 0\"/>", "checkerboard"), {"got -1"}},
        {"OverflowingTransform",
         textureOf("@@<transform name=\"to_uv\"><scale value=\"1e200\"/><scale value=\"1e200\"/></transform>",
                   "checkerboard"),
         {"not finite"}},
        {"TextureOfAnotherName",
         diffuseOf("@@<texture type=\"checkerboard\" name=\"reflektance\"/>"),
         {"did you mean \"reflectance\"?"}},
        {"TextureForANumber",
         sphereOf("@@<texture type=\"checkerboard\" name=\"radius\"/>"),
         {"\"radius\" cannot be a texture"}},
        {"UnusedTextureIsChecked", sceneOf("<texture type=\"@@noise\" id=\"t\"/>"), {"bitmap, checkerboard"}},
    };
}

class BadTexture : public testing::TestWithParam<BadText> {};
TEST_P(BadTexture, IsRefusedWithItsPlace) { expectRefused(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Scenes, BadTexture, testing::ValuesIn(badTextures()), nameOfBadText);

/// The error that reading a bitmap ends with; empty where it is read.
std::string errorOf(const std::filesystem::path& file) {
    try {
        readBitmap(file, {"scene.xml", 1, 1});
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

Image pictureOf(glm::uvec2 size) {
    Image image{.size = size, .channels = {}, .attributes = {}};
    for (const char* channel : {"B", "G", "R"})
        for (unsigned i = 0; i < size.x * size.y; ++i) image.channels[channel].push_back(float(i % 7) / 8.0f);
    return image;
}

std::string contentOf(const std::filesystem::path& file) {
    std::ostringstream content;
    content << std::ifstream(file, std::ios::binary).rdbuf();
    return content.str();
}

/// A grey JPEG of 8 x 8.
const std::string kJpegDigits =
    "ffd8ffe000104a46494600010100000100010000ffdb004300100b0c0e0c0a100e0d0e1211101318281a181616183123251d283a333d3c"
    "3933383740485c4e404457453738506d51575f626768673e4d71797064785c656763ffc0000b080008000801011100ffc4001f00000105"
    "01010101010100000000000000000102030405060708090a0bffc400b5100002010303020403050504040000017d010203000411051221"
    "31410613516107227114328191a1082342b1c11552d1f02433627282090a161718191a25262728292a3435363738393a43444546474849"
    "4a535455565758595a636465666768696a737475767778797a838485868788898a92939495969798999aa2a3a4a5a6a7a8a9aab2b3b4b5"
    "b6b7b8b9bac2c3c4c5c6c7c8c9cad2d3d4d5d6d7d8d9dae1e2e3e4e5e6e7e8e9eaf1f2f3f4f5f6f7f8f9faffda0008010100003f00483c"
    "1dff004cff004affd9";

std::string jpeg() {
    std::string bytes;
    for (std::size_t i = 0; i < kJpegDigits.size(); i += 2)
        bytes += char(std::stoi(kJpegDigits.substr(i, 2), nullptr, 16));
    return bytes;
}

/// Four inks, in several scans.
std::string progressiveJpeg() {
    JpegPicture picture{24, 16, JpegPicture::Colours::kAdobeInks, {}, true};
    for (unsigned i = 0; i < 24 * 16 * 4; ++i) picture.samples.push_back(std::uint8_t(i * 37 >> 3));
    return jpegFile(picture);
}

/// A run-length coded HDR of 16 x 4.
std::string longHdr() {
    std::string text = kHdrHead + "-Y 4 +X 16\n";
    for (int row = 0; row < 4; ++row) {
        text += std::string("\x02\x02\x00\x10", 4);
        for (int channel = 0; channel < 4; ++channel) text += std::string("\x90\x70", 2);
    }
    return text;
}

/// Whole files of every format.
std::map<std::string, std::string> wholeFiles(const TemporaryFolder& folder) {
    writeExr(folder.path() / "whole.exr", pictureOf({16, 16}));
    writePng(folder.path() / "whole.png", pictureOf({16, 16}));
    return {{"exr", contentOf(folder.path() / "whole.exr")},
            {"png", contentOf(folder.path() / "whole.png")},
            {"hdr", longHdr()},
            {"flat.hdr", kPair},
            {"interlaced.png", pngFile({9, 9, 4, 3, true, std::vector<unsigned>(81, 1), pngChunk("PLTE", "abcdef")})},
            {"jpg", jpeg()},
            {"progressive.jpg", progressiveJpeg()}};
}

TEST(DamagedBitmap, TruncatedAnywhereIsRefusedAndNamesTheFile) {
    const TemporaryFolder folder;
    for (const auto& [suffix, content] : wholeFiles(folder)) {
        const std::filesystem::path file = folder.write("a." + suffix, content);
        ASSERT_EQ(errorOf(file), "") << suffix;
        for (std::size_t length = 0; length < content.size(); length += 1 + length / 24) {
            const std::string error = errorOf(folder.write("a." + suffix, content.substr(0, length)));
            EXPECT_EQ(error.substr(0, file.string().size()), file.string()) << suffix << " of " << length << " bytes";
        }
    }
}

// In the second half of a file: sizes, in its first, are another matter (a damaged one may ask for all there is).
TEST(DamagedBitmap, RandomBytesAreReadOrRefused) {
    const TemporaryFolder folder;
    std::uint32_t state = 1;
    const auto next = [&state] { return state = state * 1664525u + 1013904223u, state >> 8; };
    for (const auto& [suffix, content] : wholeFiles(folder))
        for (int round = 0; round < 40; ++round) {
            std::string damaged = content;
            for (int i = 0; i < 3; ++i) damaged[damaged.size() / 2 + next() % (damaged.size() / 2)] = char(next());
            errorOf(folder.write("a." + suffix, damaged));  // anything but an InputError escapes
        }
}

TEST(BitmapWithoutLight, NamesItsTexel) {
    const TemporaryFolder folder;
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    for (const float bad : {-0.25f, kInfinite, -kInfinite, std::nanf("")}) {
        Image image = pictureOf({3, 2});
        image.channels["G"][4] = bad;
        writeExr(folder.path() / "bad.exr", image);
        const std::string error = errorOf(folder.path() / "bad.exr");
        EXPECT_NE(error.find("channel G at column 1, row 1"), std::string::npos) << error;
    }
}

TEST(HugeBitmap, IsRefusedWhateverItsFormat) {
    const TemporaryFolder folder;
    writeExr(folder.path() / "wide.exr", pictureOf({kMaxBitmapSize + 1, 1}));
    folder.write("wide.hdr", kHdrHead + "-Y 1 +X 65537\n");
    EXPECT_NE(errorOf(folder.path() / "wide.exr").find("at most 65536 texels a side; got 65537 x 1"),
              std::string::npos);
    EXPECT_NE(errorOf(folder.path() / "wide.hdr").find("65536"), std::string::npos);
}

TEST(BitmapWithoutColor, IsRefused) {
    const TemporaryFolder folder;
    Image image{.size = {1, 1}, .channels = {{"depth", {1.0f}}}, .attributes = {}};
    writeExr(folder.path() / "depth.exr", image);
    EXPECT_NE(errorOf(folder.path() / "depth.exr").find("R, G and B; X, Y and Z; Y, RY and BY; or Y"),
              std::string::npos);
    EXPECT_NE(errorOf(folder.write("text.png", "no picture")).find(".exr, .hdr, .png or .jpg"), std::string::npos);
}

// 1 x 1 is a colour; of one row or column, bilinear and nearest lookups meet no texel but those.
TEST(ThinBitmap, IsReadAsItIs) {
    const TemporaryFolder folder;
    for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(1, 5), glm::uvec2(5, 1)}) {
        writeExr(folder.path() / "thin.exr", pictureOf(size));
        for (const char* wrap : {"repeat", "mirror", "clamp"}) {
            const std::string text =
                textureOf("<string name=\"filename\" value=\"" + (folder.path() / "thin.exr").string() +
                          "\"/><string name=\"wrap_mode\" value=\"" + wrap + "\"/>");
            const CompiledScene scene = compileScene(readText(text), {});
            EXPECT_EQ(scene.textures.size(), size == glm::uvec2(1) ? 0u : 1u);
            for (const glm::dvec2 uv : {glm::dvec2(0), glm::dvec2(1), glm::dvec2(0.5), glm::dvec2(-7.3, 12.9)}) {
                const glm::dvec3 color = reference::reflectanceAt(scene, scene.shapes.at(0), uv);
                EXPECT_GE(color.x, 0);
                EXPECT_LE(color.x, 0.5);
            }
        }
    }
}

}  // namespace
}  // namespace parhelion::test
