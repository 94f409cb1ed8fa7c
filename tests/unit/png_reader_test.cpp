// PNG files, byte by byte: every colour type and depth, and what the other chunks say.
#include <gtest/gtest.h>

#include <map>

#include "support/bitmap_reading.h"
#include "support/picture_files.h"

namespace parhelion::test {
namespace {

std::string number(unsigned value) {
    return {char(value >> 24), char(value >> 16 & 0xff), char(value >> 8 & 0xff), char(value & 0xff)};
}

/// Red, green and blue of every texel in 1/65535.
std::vector<glm::ivec3> codesOf(const Bitmap& bitmap) {
    std::vector<glm::ivec3> codes;
    for (const glm::vec3& texel : bitmap.texels) codes.emplace_back(glm::round(texel * 65535.0f));
    return codes;
}

/// A picture of 13 x 5 with samples of every size.
PngPicture pictureOf(unsigned colorType, unsigned bits) {
    PngPicture picture{13, 5, bits, colorType, false, {}};
    for (unsigned i = 0; i < 13 * 5 * picture.channels(); ++i)
        picture.samples.push_back((i * 40503u + 17u) % (1u << bits));
    return picture;
}

/// What its texels are, grey or red, green and blue.
std::vector<glm::ivec3> expectedCodes(const PngPicture& picture) {
    std::vector<glm::ivec3> codes;
    const unsigned scale = 65535 / ((1u << picture.bits) - 1), step = picture.channels();
    for (std::size_t i = 0; i < picture.samples.size(); i += step) {
        const auto at = [&](std::size_t k) { return int(picture.samples[i + k] * scale); };
        codes.push_back(step < 3 ? glm::ivec3(at(0)) : glm::ivec3(at(0), at(1), at(2)));
    }
    return codes;
}

TEST(PngColours, OfEveryTypeAndDepthAreRead) {
    const std::map<unsigned, std::vector<unsigned>> depths{
        {0, {1, 2, 4, 8, 16}}, {2, {8, 16}}, {4, {8, 16}}, {6, {8, 16}}};
    for (const auto& [colorType, bits] : depths)
        for (const unsigned depth : bits)
            for (const bool isInterlaced : {false, true}) {
                PngPicture picture = pictureOf(colorType, depth);
                picture.isInterlaced = isInterlaced;
                const Bitmap bitmap = bitmapOf(pngFile(picture));
                EXPECT_EQ(bitmap.size, glm::uvec2(13, 5));
                EXPECT_EQ(codesOf(bitmap), expectedCodes(picture)) << colorType << " of " << depth << isInterlaced;
                EXPECT_EQ(notesOf(bitmap), "");
            }
}

TEST(PngColours, OfPalettesAreTheirEntries) {
    for (const unsigned bits : {1u, 2u, 4u, 8u}) {
        PngPicture picture{2, 1, bits, 3, false, {1, 0}};
        // Transparency is ignored.
        picture.chunks = pngChunk("PLTE", "\x10\x20\x30\x40\x50\x60") + pngChunk("tRNS", std::string("\x00\x80", 2));
        const std::vector<glm::ivec3> expected{glm::ivec3(0x40, 0x50, 0x60) * 257, glm::ivec3(0x10, 0x20, 0x30) * 257};
        EXPECT_EQ(codesOf(bitmapOf(pngFile(picture))), expected) << bits;
    }
}

TEST(PngColours, OfTransparentTexelsAreKept) {
    PngPicture grey{2, 1, 8, 0, false, {7, 9}, pngChunk("tRNS", std::string("\x00\x07", 2))};
    EXPECT_EQ(codesOf(bitmapOf(pngFile(grey))), expectedCodes(grey));
    PngPicture rgba{1, 1, 8, 6, false, {200, 100, 50, 0}};
    EXPECT_EQ(codesOf(bitmapOf(pngFile(rgba))), expectedCodes(rgba));
}

// sRGB of 188 / 255 is .50289 (IEC 61966-2-1); raw values stay.
TEST(PngColours, AreSrgbUnlessRaw) {
    const std::string file = pngFile({1, 1, 8, 0, false, {188}});
    EXPECT_NEAR(bitmapOf(file, BitmapEncoding::kSrgb).texels[0].r, 0.502886f, 1e-6f);
    EXPECT_EQ(bitmapOf(file, BitmapEncoding::kRaw).texels[0].r, 188.0f / 255.0f);
}

/// The notes on a grey texel's file with these chunks.
std::string notesWith(const std::string& chunks, BitmapEncoding encoding = BitmapEncoding::kSrgb) {
    return notesOf(bitmapOf(pngFile({1, 1, 8, 0, false, {1}, chunks}), encoding));
}

std::string primaries(unsigned redX, unsigned redY) {
    return pngChunk("cHRM", number(31270) + number(32900) + number(redX) + number(redY) + number(30000) +
                                number(60000) + number(15000) + number(6000));
}

/// A colour profile of that name, without tags; libpng wants it longer than what zlib makes of zeros.
std::string profile(const std::string& name) {
    std::string bytes(132, '\0');
    for (unsigned i = 0, state = 1; i < 96; ++i) bytes += char((state = state * 1664525u + 1013904223u) >> 24);
    const auto put = [&bytes](std::size_t at, const std::string& text) { bytes.replace(at, text.size(), text); };
    put(0, number(unsigned(bytes.size())));
    put(8, "\x02");
    put(12, "mntrGRAYXYZ ");
    put(36, "acsp");
    put(68, number(0xf6d6) + number(0x10000) + number(0xd32d));  // the white that all profiles refer to
    return pngChunk("iCCP", name + std::string(2, '\0') + deflated(bytes));
}

TEST(PngColourSpaces, AreNotedWhereTheyAreNotSrgb) {
    EXPECT_EQ(notesWith(pngChunk("sRGB", std::string(1, '\0'))), "");
    EXPECT_EQ(notesWith(pngChunk("gAMA", number(45455)) + primaries(64000, 33000)), "");
    EXPECT_NE(notesWith(pngChunk("gAMA", number(100000))).find("gAMA 1 has no effect"), std::string::npos);
    EXPECT_NE(notesWith(primaries(68000, 32000)).find("cHRM has no effect"), std::string::npos);
    EXPECT_EQ(notesWith(profile("sRGB IEC61966-2.1")), "");
    EXPECT_EQ(notesWith(profile("Display P3")),
              "picture: the colour profile of chunk iCCP has no effect: colours are taken for sRGB, as in Mitsuba\n");
    EXPECT_EQ(notesWith(pngChunk("cICP", std::string("\x01\x0d\x00\x01", 4))), "");
    EXPECT_NE(notesWith(pngChunk("cICP", std::string("\x0c\x0d\x00\x01", 4))).find("cICP has no effect"),
              std::string::npos);
    EXPECT_EQ(notesWith(pngChunk("gAMA", number(100000)) + primaries(68000, 32000), BitmapEncoding::kRaw), "");
}

TEST(PngNotes, TellOfWhatIsNotRead) {
    const std::string file = pngFile({1, 1, 8, 0, false, {1}});
    EXPECT_NE(notesOf(bitmapOf(file + "some tail")).find("9 bytes after the end of the picture"), std::string::npos);
    EXPECT_NE(notesWith(pngChunk("acTL", number(2) + number(0))).find("animation"), std::string::npos);
    for (const bool isBigEndian : {false, true}) {
        const std::string notes = notesWith(pngChunk("eXIf", exifData(6, isBigEndian)));
        EXPECT_NE(notes.find("EXIF orientation, 6, has no effect"), std::string::npos) << notes;
        EXPECT_EQ(notesWith(pngChunk("eXIf", exifData(1, isBigEndian))), "");
        std::string behind = file;  // the picture's data, before the end's twelve bytes
        behind.insert(behind.size() - 12, pngChunk("eXIf", exifData(6, isBigEndian)));
        EXPECT_NE(notesOf(bitmapOf(behind)).find("EXIF orientation, 6"), std::string::npos);
    }
    std::string text = pngChunk("tEXt", std::string("Title\0a", 7));
    EXPECT_EQ(notesWith(text), "");
    text.back() ^= 1;  // its checksum
    EXPECT_NE(notesWith(text).find("libpng warns"), std::string::npos);
}

/// The file with one bit of the byte `offset` into the first chunk of that type's content, or its checksum, flipped.
std::string damagedIn(const std::string& file, const std::string& type, int offset) {
    std::string damaged = file;
    damaged.at(damaged.find(type) + 4 + std::size_t(offset)) ^= 1;
    return damaged;
}

TEST(PngDamage, IsRefusedWithItsReason) {
    PngPicture picture = pictureOf(2, 8);
    const std::string file = pngFile(picture);
    EXPECT_NE(bitmapError(damagedIn(file, "IHDR", 13)).find("CRC"), std::string::npos);
    EXPECT_NE(bitmapError(damagedIn(file, "IDAT", 20)).find("libpng says"), std::string::npos);
    std::string lastSum = file;
    lastSum[file.size() - 13] ^= 1;  // of the pixels
    EXPECT_NE(bitmapError(lastSum).find("CRC"), std::string::npos);
    PngPicture palette{2, 1, 8, 3, false, {1, 0}, pngChunk("PLTE", "\x10\x20\x30\x40\x50\x60")};
    EXPECT_NE(bitmapError(damagedIn(pngFile(palette), "PLTE", 1)).find("CRC"), std::string::npos);
    EXPECT_NE(bitmapError(file.substr(0, file.size() - 12)).find("without its last chunk, IEND"), std::string::npos);
    EXPECT_NE(bitmapError(file.substr(0, 50)).find("says that it has"), std::string::npos);
    const std::string noPixels = file.substr(0, file.find("IDAT") - 4) + pngChunk("IEND", "");
    EXPECT_NE(bitmapError(noPixels).find("0 bytes of pixels cannot hold 13 x 5"), std::string::npos);
}

TEST(PngDamage, OfSizesIsRefusedBeforeThereIsRoomForThem) {
    const auto sized = [](unsigned width, unsigned height) {
        return "\x89PNG\r\n\x1a\n" +
               pngChunk("IHDR", number(width) + number(height) + std::string("\x08\x02\x00\x00\x00", 5)) +
               pngChunk("IDAT", std::string(40, 'x')) + pngChunk("IEND", "");
    };
    EXPECT_NE(bitmapError(sized(30000, 30000)).find("40 bytes of pixels cannot hold 30000 x 30000"), std::string::npos);
    EXPECT_NE(bitmapError(sized(70000, 1)).find("cannot hold 70000 x 1"), std::string::npos);
    EXPECT_NE(bitmapError(sized(0, 1)).find("at least one texel"), std::string::npos);
    // Rows for the second header's size, and the first one's pixels.
    const std::string first = pngFile({13, 200, 8, 0, false, std::vector<unsigned>(13 * 200, 7)});
    const std::string second = pngChunk("IHDR", number(13) + number(1) + std::string("\x08\x00\x00\x00\x00", 5));
    const std::size_t end = first.size() - 12;
    EXPECT_NE(bitmapError(first.substr(0, end) + second + first.substr(end)).find("got a second one"),
              std::string::npos);
}

// What Apple's tools make of a PNG: a chunk before all others, pixels without a checksum of their own.
TEST(PngOfPhones, AreRefusedForWhatTheyAre) {
    const std::string file = pngFile({1, 1, 8, 6, false, {255, 0, 0, 255}});
    const std::string phone = file.substr(0, 8) + pngChunk("CgBI", std::string("\x50\x00\x20\x06", 4)) + file.substr(8);
    EXPECT_NE(bitmapError(phone).find("rewrote for iPhones (chunk CgBI: red and blue swapped"), std::string::npos);
}

TEST(OtherFormats, AreCalledByTheirNames) {
    const std::map<std::string, std::string> names{{std::string("II*\0abcd", 8), "TIFF"},
                                                   {"RIFF1234WEBPVP8 ", "WebP"},
                                                   {std::string("\0\0\0\x18", 4) + "ftypheic", "HEIF"},
                                                   {"BM123456", "BMP"},
                                                   {"GIF89a", "GIF"},
                                                   {"version https://git-lfs.github.com/spec/v1\n", "Git LFS"},
                                                   {"", "empty"},
                                                   {"<!DOCTYPE html>", "markup"},
                                                   {"something else", "begins as none of them"}};
    for (const auto& [content, name] : names) {
        const std::string error = bitmapError(content);
        EXPECT_NE(error.find("must be a whole .exr, .hdr, .png or .jpg file; got"), std::string::npos) << error;
        EXPECT_NE(error.find(name), std::string::npos) << error;
    }
}

}  // namespace
}  // namespace parhelion::test
