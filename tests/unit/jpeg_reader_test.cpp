// JPEG files of every kind that libjpeg writes, what cameras add to them, and damage.
#include <gtest/gtest.h>

#include <cmath>

#include "support/bitmap_reading.h"
#include "support/picture_files.h"

namespace parhelion::test {
namespace {

using Colours = JpegPicture::Colours;

/// A smooth picture of 40 x 24.
JpegPicture pictureOf(Colours colours) {
    JpegPicture picture{40, 24, colours, {}};
    for (unsigned y = 0; y < 24; ++y)
        for (unsigned x = 0; x < 40; ++x)
            for (unsigned channel = 0; channel < picture.channels(); ++channel)
                picture.samples.push_back(std::uint8_t(20 + 4 * x + 2 * y + 11 * channel));
    return picture;
}

/// The largest difference of a code value from expected(x, y, channel).
template <typename Expected>
double largestError(const Bitmap& bitmap, const Expected& expected) {
    double largest = 0.0;
    for (unsigned y = 0; y < bitmap.size.y; ++y)
        for (unsigned x = 0; x < bitmap.size.x; ++x)
            for (int channel = 0; channel < 3; ++channel)
                largest = std::max(largest, std::abs(bitmap.at(x, y)[channel] * 255.0 - expected(x, y, channel)));
    return largest;
}

// Quality 100 quantises coefficients to whole numbers: their 64 roundings of at most 1/2, orthonormal, move a sample by
// .29 rms; the colour matrix, whose rows' norms are up to 2.1, and three more roundings to bytes leave it within 4.
constexpr double kLossy = 4.0;

TEST(JpegColours, GreyAndRgbAreWhatWasWritten) {
    const JpegPicture grey = pictureOf(Colours::kGrey), rgb = pictureOf(Colours::kRgb);
    EXPECT_LE(largestError(bitmapOf(jpegFile(grey)), [](unsigned x, unsigned y, int) { return 20.0 + 4 * x + 2 * y; }),
              kLossy);
    const Bitmap bitmap = bitmapOf(jpegFile(rgb));
    EXPECT_EQ(bitmap.size, glm::uvec2(40, 24));
    EXPECT_LE(largestError(bitmap, [](unsigned x, unsigned y, int c) { return 20.0 + 4 * x + 2 * y + 11 * c; }),
              kLossy);
    EXPECT_EQ(notesOf(bitmap), "");
}

// The same coefficients, so the same texels to the bit.
TEST(JpegCodings, ProgressiveArithmeticAndSeveralScansAreThePictureOfOneScan) {
    for (const Colours colours : {Colours::kGrey, Colours::kRgb}) {
        JpegPicture picture = pictureOf(colours);
        const Bitmap plain = bitmapOf(jpegFile(picture));
        picture.isProgressive = true;
        EXPECT_EQ(bitmapOf(jpegFile(picture)).texels, plain.texels);
        picture.isArithmetic = true;
        EXPECT_EQ(bitmapOf(jpegFile(picture)).texels, plain.texels);
        picture.isProgressive = false;
        EXPECT_EQ(bitmapOf(jpegFile(picture)).texels, plain.texels);
        picture.isArithmetic = false;
        picture.hasScanPerComponent = true;
        EXPECT_EQ(bitmapOf(jpegFile(picture)).texels, plain.texels);
    }
}

// Inks leave (1 - C)(1 - K) of red; Adobe writes what is left.
TEST(JpegColours, OfInksAreMultiplied) {
    for (const bool isAdobe : {false, true}) {
        const Bitmap bitmap = bitmapOf(jpegFile(pictureOf(isAdobe ? Colours::kAdobeInks : Colours::kInks)));
        const auto expected = [isAdobe](unsigned x, unsigned y, int c) {
            const double ink = 20 + 4 * x + 2 * y + 11 * c, black = 20 + 4 * x + 2 * y + 33;
            return isAdobe ? ink * black / 255.0 : (255 - ink) * (255 - black) / 255.0;
        };
        EXPECT_LE(largestError(bitmap, expected), 2 * kLossy) << isAdobe;
        EXPECT_NE(notesOf(bitmap).find("CMYK"), std::string::npos);
    }
}

TEST(JpegColours, OfOtherNumbersOfComponentsAreRefused) {
    EXPECT_NE(bitmapError(jpegFile(pictureOf(Colours::kTwo))).find("1, 3 or 4 components; got 2"), std::string::npos);
}

TEST(JpegNotes, TellOfWhatCamerasAdd) {
    JpegPicture picture = pictureOf(Colours::kRgb);
    const Bitmap plain = bitmapOf(jpegFile(picture));
    // A motion photo: a film behind the end, which has markers of its own in it.
    const Bitmap motion = bitmapOf(jpegFile(picture) + std::string("\0\0\0\x18", 4) + "ftypmp42 \xff\xd8\xff\xda film");
    EXPECT_EQ(motion.texels, plain.texels);
    EXPECT_NE(notesOf(motion).find("22 bytes after the end of the picture are not read"), std::string::npos)
        << notesOf(motion);
    for (const bool isBigEndian : {false, true})
        for (const unsigned orientation : {1u, 3u, 8u}) {
            picture.markers = {{1, std::string("Exif\0\0", 6) + exifData(orientation, isBigEndian)}};
            const Bitmap turned = bitmapOf(jpegFile(picture));
            EXPECT_EQ(turned.texels, plain.texels);
            const std::string wanted = "EXIF orientation, " + std::to_string(orientation) + ", has no effect";
            EXPECT_EQ(notesOf(turned).find(wanted) != std::string::npos, orientation != 1);
        }
}

std::string profileMarker(const std::string& name) {
    return std::string("ICC_PROFILE\0\x01\x01", 14) + std::string(128, '\0') + name;
}

TEST(JpegNotes, TellOfProfilesOtherThanSrgb) {
    JpegPicture picture = pictureOf(Colours::kRgb);
    picture.markers = {{2, profileMarker(std::string("s\0R\0G\0B\0 \0I\0E\0C\0", 16))}};
    EXPECT_EQ(notesOf(bitmapOf(jpegFile(picture), BitmapEncoding::kSrgb)), "");
    picture.markers = {{2, profileMarker("Display P3")}};
    EXPECT_NE(notesOf(bitmapOf(jpegFile(picture), BitmapEncoding::kSrgb)).find("colour profile has no effect"),
              std::string::npos);
    EXPECT_EQ(notesOf(bitmapOf(jpegFile(picture), BitmapEncoding::kRaw)), "");
}

TEST(JpegDamage, TruncatedAnywhereIsRefused) {
    for (const bool isProgressive : {false, true}) {
        JpegPicture picture = pictureOf(Colours::kRgb);
        picture.isProgressive = isProgressive;
        const std::string file = jpegFile(picture);
        for (std::size_t length = 2; length < file.size(); length += 1 + length / 16)
            EXPECT_NE(bitmapError(file.substr(0, length)), "") << length << " of " << file.size();
        EXPECT_NE(bitmapError(file.substr(0, file.size() - 2)).find("Premature end of JPEG file"), std::string::npos);
    }
}

// The end's marker right behind the first of three scans.
TEST(JpegDamage, ComponentsWithoutAScanAreRefused) {
    JpegPicture picture = pictureOf(Colours::kRgb);
    picture.hasScanPerComponent = true;
    const std::string file = jpegFile(picture);
    std::size_t second = file.find("\xff\xda", file.find("\xff\xda") + 2);
    // Tables of the second scan stand before it.
    second = std::min(second, file.find("\xff\xc4", file.find("\xff\xda")));
    EXPECT_NE(bitmapError(file.substr(0, second) + "\xff\xd9").find("some of its components have no scan"),
              std::string::npos);
}

TEST(JpegDamage, OfSizesIsRefusedBeforeThereIsRoomForThem) {
    std::string file = jpegFile(pictureOf(Colours::kGrey));
    const std::size_t size = file.find("\xff\xc0") + 5;
    file.replace(size, 4, std::string("\xf0\x00\xf0\x00", 4));
    EXPECT_NE(bitmapError(file).find("cannot hold 61440 x 61440 texels"), std::string::npos) << bitmapError(file);
}

}  // namespace
}  // namespace parhelion::test
