// Radiance pictures, byte by byte: every coding, orientation and variable of the format.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "support/bitmap_reading.h"

namespace parhelion::test {
namespace {

const std::string kHead = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";

/// mantissa / 256 * 2^(exponent - 128): 128, 64, 32 and 129 are (1, 1/2, 1/4).
std::string pixel(int red, int green, int blue, int exponent) {
    return {char(red), char(green), char(blue), char(exponent)};
}
const std::string kOne = pixel(128, 128, 128, 129), kHalf = pixel(128, 128, 128, 128);

/// A scanline of one value, each component in one newer run; at most 127 pixels.
std::string codedLine(int length, const std::string& value) {
    std::string line = std::string("\x02\x02", 2) + char(length / 256) + char(length % 256);
    for (const char component : value) line += std::string{char(128 + length), component};
    return line;
}

std::string repeat(const std::string& text, std::size_t count) {
    std::string result;
    for (std::size_t i = 0; i < count; ++i) result += text;
    return result;
}

void expectAll(const Bitmap& bitmap, const glm::uvec2& size, const glm::vec3& value) {
    EXPECT_EQ(bitmap.size, size);
    for (const glm::vec3& texel : bitmap.texels) EXPECT_EQ(texel, value);
}

TEST(RadiancePixels, AreMantissasOfOneExponent) {
    const Bitmap bitmap = bitmapOf(kHead + "-Y 1 +X 4\n" + pixel(128, 64, 32, 129) + pixel(255, 1, 0, 128) +
                                   pixel(255, 255, 255, 0) + pixel(255, 128, 0, 255));
    EXPECT_EQ(bitmap.texels[0], glm::vec3(1.0f, 0.5f, 0.25f));
    EXPECT_EQ(bitmap.texels[1], glm::vec3(255.0f / 256, 1.0f / 256, 0.0f));
    EXPECT_EQ(bitmap.texels[2], glm::vec3(0.0f));
    EXPECT_EQ(bitmap.texels[3], glm::vec3(0x1.fep126f, 0x1p126f, 0.0f));
    EXPECT_EQ(notesOf(bitmap), "");
}

TEST(RadianceCodings, OldRunsRepeatTheLastPixel) {
    expectAll(bitmapOf(kHead + "-Y 3 +X 16\n" + repeat(kOne + pixel(1, 1, 1, 15), 3)), {16, 3}, glm::vec3(1));
    // Consecutive runs count in ever higher bytes: 43 + 256 * 1, and 0 + 256 * 0 + 65536 * 1.
    expectAll(bitmapOf(kHead + "-Y 1 +X 300\n" + kOne + pixel(1, 1, 1, 43) + pixel(1, 1, 1, 1)), {300, 1},
              glm::vec3(1));
    expectAll(bitmapOf(kHead + "-Y 1 +X 65536\n" + kOne + pixel(1, 1, 1, 255) + pixel(1, 1, 1, 255)), {65536, 1},
              glm::vec3(1));
    // A pixel in between starts over: 1, 2 x 1, 1/2, 2 x 1/2.
    const Bitmap two = bitmapOf(kHead + "-Y 1 +X 6\n" + kOne + pixel(1, 1, 1, 2) + kHalf + pixel(1, 1, 1, 2));
    for (unsigned x = 0; x < 6; ++x) EXPECT_EQ(two.at(x, 0), glm::vec3(x < 3 ? 1.0f : 0.5f)) << x;
}

TEST(RadianceCodings, MayDifferFromScanlineToScanline) {
    const Bitmap bitmap = bitmapOf(kHead + "-Y 4 +X 9\n" + codedLine(9, kOne) + repeat(kHalf, 9) +
                                   (kOne + pixel(1, 1, 1, 8)) + codedLine(9, kHalf));
    ASSERT_EQ(bitmap.size, glm::uvec2(9, 4));
    for (unsigned y = 0; y < 4; ++y)
        for (unsigned x = 0; x < 9; ++x) EXPECT_EQ(bitmap.at(x, y), glm::vec3(y % 2 == 0 ? 1.0f : 0.5f)) << x << y;
    EXPECT_EQ(notesOf(bitmap), "");
}

TEST(RadianceCodings, NewRunsMixWithPieces) {
    std::string line("\x02\x02\x00\x08", 4);
    line += std::string("\x08\x80\x81\x82\x83\x84\x85\x86\x87", 9);  // a piece of eight
    line += std::string("\x83\x40\x05\x01\x02\x03\x04\x05", 8);      // a run of three, a piece of five
    line += std::string("\x88\x20", 2) + std::string("\x81\x80\x87\x80", 4);
    const Bitmap bitmap = bitmapOf(kHead + "-Y 1 +X 8\n" + line);
    constexpr std::array<int, 8> kGreen{64, 64, 64, 1, 2, 3, 4, 5};
    for (unsigned x = 0; x < 8; ++x) EXPECT_EQ(bitmap.at(x, 0), glm::vec3(128 + x, kGreen[x], 32) / 256.0f) << x;
}

// What would start a coded scanline is a pixel where scanlines are too short or too long for that coding.
TEST(RadianceCodings, ShortAndLongScanlinesAreNeverCodedByComponent) {
    const std::string looksCoded = pixel(2, 2, 0, 7);
    const Bitmap narrow = bitmapOf(kHead + "-Y 1 +X 7\n" + looksCoded + repeat(kOne, 6));
    EXPECT_EQ(narrow.at(0, 0), glm::vec3(std::ldexp(2.0f, 7 - 136), std::ldexp(2.0f, 7 - 136), 0.0f));
    EXPECT_EQ(narrow.at(6, 0), glm::vec3(1));
    expectAll(bitmapOf(kHead + "-Y 1 +X 32768\n" + repeat(kOne, 32768)), {32768, 1}, glm::vec3(1));
    expectAll(bitmapOf(kHead + "-Y 2 +X 1\n" + kOne + kOne), {1, 2}, glm::vec3(1));
}

/// A picture of 3 x 2 whose texel (x, y), y down, has the red mantissa 128 + 3 y + x, in an orientation.
Bitmap oriented(const std::string& slow, const std::string& fast) {
    const auto length = [](const std::string& axis) { return axis[1] == 'X' ? 3 : 2; };
    // y points up in the format.
    const auto place = [&](const std::string& axis, int n) {
        const bool increases = axis[0] == '+';
        if (axis[1] == 'X') return increases ? n : 2 - n;
        return increases ? 1 - n : n;
    };
    std::string pixels;
    for (int i = 0; i < length(slow); ++i)
        for (int j = 0; j < length(fast); ++j) {
            const int x = slow[1] == 'X' ? place(slow, i) : place(fast, j);
            const int y = slow[1] == 'X' ? place(fast, j) : place(slow, i);
            pixels += pixel(128 + 3 * y + x, 0, 0, 128);
        }
    return bitmapOf(kHead + slow + " " + std::to_string(length(slow)) + " " + fast + " " +
                    std::to_string(length(fast)) + "\n" + pixels);
}

TEST(RadianceOrientation, EachOfTheEightComesUpright) {
    for (const std::string y : {"-Y", "+Y"})
        for (const std::string x : {"+X", "-X"})
            for (const bool swaps : {false, true}) {
                const Bitmap bitmap = swaps ? oriented(x, y) : oriented(y, x);
                ASSERT_EQ(bitmap.size, glm::uvec2(3, 2)) << y << x << swaps;
                for (unsigned i = 0; i < 6; ++i)
                    EXPECT_EQ(bitmap.texels[i].r, float(128 + i) / 256.0f) << y << x << swaps << " texel " << i;
            }
}

std::string withLines(const std::string& lines, const std::string& pixels = kOne) {
    return "#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + pixels;
}

TEST(RadianceExposure, IsDividedOutAndNoted) {
    const Bitmap bitmap = bitmapOf(withLines("EXPOSURE=2.0\nEXPOSURE= 2e0\n"));
    EXPECT_EQ(bitmap.texels[0], glm::vec3(0.25f));
    EXPECT_NE(notesOf(bitmap).find("picture:3:1: EXPOSURE and COLORCORR multiply to 4"), std::string::npos);
    const Bitmap coloured = bitmapOf(withLines("EXPOSURE=0.5\nCOLORCORR= 1 2 4\nCOLORCORR=2 2 2\n"));
    EXPECT_EQ(coloured.texels[0], glm::vec3(1.0f, 0.5f, 0.25f));
    EXPECT_NE(notesOf(coloured).find("picture:4:1: EXPOSURE and COLORCORR multiply to (1, 2, 4)"), std::string::npos);
    EXPECT_EQ(notesOf(bitmapOf(withLines("EXPOSURE=          1.0000000000000\n"))), "");
    // Said of a picture that this one was made from.
    EXPECT_EQ(bitmapOf(withLines("\tEXPOSURE=4\n")).texels[0], glm::vec3(1));
}

// Row sums of Mitsuba's matrix from XYZ.
TEST(RadianceColours, OfXyzAreConverted) {
    const Bitmap bitmap = bitmapOf("#?RADIANCE\nFORMAT=32-bit_rle_xyze\nEXPOSURE=2\n\n-Y 1 +X 1\n" + kOne);
    const glm::vec3 expected = glm::vec3(1.204794f, 0.948291f, 0.908916f) * 0.5f;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(bitmap.texels[0][i], expected[i], 1e-6f);
}

// Display P3 to Rec. 709, with the four decimals of its published matrix.
TEST(RadianceColours, OfOtherPrimariesAreConverted) {
    const std::string line = "PRIMARIES= 0.680 0.320 0.265 0.690 0.150 0.060 0.3127 0.3290\n";
    const Bitmap bitmap = bitmapOf(withLines(line, pixel(128, 128, 64, 128)));
    const glm::vec3 expected(0.5f * (1.2249f - 0.2249f), 0.5f * (1.0421f - 0.0421f),
                             0.25f * 1.0983f - 0.5f * (0.0196f + 0.0786f));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(bitmap.texels[0][i], expected[i], 5e-5f * (0.5f + 0.5f + 0.25f));
    // Rec. 709 itself changes nothing; nor do the zeros that Photoshop writes.
    for (const std::string same :
         {"PRIMARIES=0.640 0.330 0.300 0.600 0.150 0.060 0.3127 0.3290\n", "PRIMARIES=0 0 0 0 0 0 0 0\n"}) {
        const Bitmap kept = bitmapOf(withLines(same, pixel(128, 64, 32, 129)));
        EXPECT_EQ(kept.texels[0], glm::vec3(1.0f, 0.5f, 0.25f));
        EXPECT_EQ(notesOf(kept), "");
    }
}

TEST(RadianceHeaders, OfAllProgramsAreRead) {
    const std::string size = "\n-Y 1 +X 1\n", format = "FORMAT=32-bit_rle_rgbe\n";
    for (const std::string& text :
         {"#?RGBE\n" + format + size, "#?AUTOPANO v3\n# made by a program\n" + format + "SOFTWARE=x = y\n" + size,
          "#?RADIANCE\nrpict -vtv -vp 0 0 0 scene.oct\nVIEW= -vtv -vh 45\nCAPDATE= 2020:01:01\n" + format + size,
          std::string("#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 1 +X 1\r\n"),
          "#?RADIANCE\nFORMAT= 32-bit_rle_rgbe \n" + format + size, "pfilt -1\n" + format + size, format + size}) {
        const Bitmap bitmap = bitmapOf(text + kOne);
        EXPECT_EQ(bitmap.texels.at(0), glm::vec3(1)) << text;
        EXPECT_EQ(notesOf(bitmap), "") << text;
    }
    EXPECT_NE(notesOf(bitmapOf("#?RADIANCE\n" + size + kOne)).find("has no FORMAT"), std::string::npos);
}

TEST(RadianceHeaders, NoteWhatHasNoEffect) {
    const std::string notes = notesOf(bitmapOf(withLines("PIXASPECT=0.5\nGAMMA=2.2\n") + "tail"));
    EXPECT_NE(notes.find("picture:2:1: \"PIXASPECT=0.5\" has no effect"), std::string::npos) << notes;
    EXPECT_NE(notes.find("picture:3:1: \"GAMMA=2.2\" has no effect"), std::string::npos) << notes;
    EXPECT_NE(notes.find("4 bytes after the last scanline are not read"), std::string::npos) << notes;
    EXPECT_EQ(notesOf(bitmapOf(withLines("PIXASPECT=1\nGAMMA=1\n"))), "");
    EXPECT_NE(
        notesOf(bitmapOf("#?RADIANCE\nFORMAT=32-bit_rle_xyze\nPRIMARIES=1 0 0 1 0 0 0.3 0.3\n\n-Y 1 +X 1\n" + kOne))
            .find("PRIMARIES has no effect on X, Y and Z"),
        std::string::npos);
}

struct BadPicture {
    std::string content, mention;
};

std::map<std::string, BadPicture> badPictures() {
    const std::string wide = kHead + "-Y 1 +X 8\n";
    const std::string coded("\x02\x02\x00\x08", 4);
    return {
        {"EndlessHeader", {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", "header ends before an empty line"}},
        {"NoResolution", {kHead, "header ends before the line of the resolution"}},
        {"OtherFormat", {"#?RADIANCE\nFORMAT=ascii\n\n-Y 1 +X 1\n", "picture:2:1: FORMAT must be 32-bit_rle_rgbe or"}},
        {"TwoFormats", {withLines("FORMAT=32-bit_rle_xyze\n"), "picture:3:1: FORMAT must be given once"}},
        {"ZeroExposure", {withLines("EXPOSURE=0\n"), "picture:2:1: EXPOSURE must be > 0; got \"0\""}},
        {"NegativeExposure", {withLines("EXPOSURE=-2\n"), "EXPOSURE must be > 0"}},
        {"InfiniteExposure", {withLines("EXPOSURE=inf\n"), "EXPOSURE must be 1 number; got \"inf\""}},
        {"WordyExposure", {withLines("EXPOSURE=2 stops\n"), "EXPOSURE must be 1 number"}},
        {"HugeExposures", {withLines("EXPOSURE=1e20\nEXPOSURE=1e20\n"), "picture:3:1: EXPOSURE and COLORCORR must"}},
        {"TwoCorrections", {withLines("COLORCORR=1 2\n"), "COLORCORR must be 3 numbers"}},
        {"ZeroCorrection", {withLines("COLORCORR=1 0 1\n"), "COLORCORR must be > 0"}},
        {"SevenPrimaries", {withLines("PRIMARIES=1 2 3 4 5 6 7\n"), "PRIMARIES must be 8 numbers"}},
        {"FlatPrimaries", {withLines("PRIMARIES=.1 .1 .2 .2 .3 .3 .3 .3\n"), "picture:2:1: PRIMARIES must span"}},
        {"OneAxis", {kHead + "-Y 1\n" + kOne, "picture:4:1: the line of the resolution must be"}},
        {"SameAxes", {kHead + "-Y 1 +Y 1\n" + kOne, "the line of the resolution must be"}},
        {"NoSign", {kHead + "Y 1 X 1\n" + kOne, "the line of the resolution must be"}},
        {"WordySize", {kHead + "-Y 1 +X one\n" + kOne, "the line of the resolution must be"}},
        {"EmptySize", {kHead + "-Y 0 +X 1\n", "at least one texel"}},
        {"HugeSize", {kHead + "-Y 1 +X 99999999999999999999\n", "at most 65536 texels a side"}},
        {"TooManyScanlines", {kHead + "-Y 60000 +X 60000\n" + kOne, "4 bytes cannot hold its 60000 scanlines"}},
        {"OtherLength", {wide + std::string("\x02\x02\x00\x09", 4) + kOne, "says that it has 9 pixels, not 8"}},
        {"LongRun", {wide + coded + std::string("\x89\x80", 2) + kOne, "has 9 values of a component where 8 are left"}},
        {"LongPiece", {wide + coded + "\x84\x80\x05" + kOne + kOne, "has 5 values of a component where 4 are left"}},
        {"EmptyPiece", {wide + coded + std::string("\x00\x80", 2), "has 0 values of a component"}},
        {"RunOfNothing", {wide + pixel(1, 1, 1, 8), "begins with a run, which repeats nothing"}},
        {"LongOldRun", {wide + kOne + pixel(1, 1, 1, 8), "has a run of 8 pixels where 7 are left"}},
        {"HugeOldRun", {wide + kOne + repeat(pixel(1, 1, 1, 0), 7) + pixel(1, 1, 1, 1), "where 7 are left"}},
        {"OldRunOverTheEdge", {kHead + "-Y 2 +X 4\n" + kOne + pixel(1, 1, 1, 7), "scanline 1 of 2 has a run of 7"}},
        {"CutPixel", {kHead + "-Y 1 +X 2\n" + kOne + "\x80", "scanline 1 of 1 is cut off at byte"}},
        {"CutComponent", {kHead + "-Y 2 +X 8\n" + codedLine(8, kOne) + coded + "\x88", "scanline 2 of 2 is cut off"}},
        {"OverflowingTexel", {withLines("EXPOSURE=0.01\n", pixel(255, 0, 0, 255)), "texels must be finite"}},
    };
}

TEST(RadianceDamage, IsRefusedWithItsPlaceAndReason) {
    for (const auto& [name, bad] : badPictures()) {
        const std::string error = bitmapError(bad.content);
        EXPECT_NE(error.find(bad.mention), std::string::npos) << name << ": " << error;
    }
}

}  // namespace
}  // namespace parhelion::test
