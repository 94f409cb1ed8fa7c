#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "image/bitmap.h"
#include "image/image.h"
#include "image/tone_curve.h"
#include "support/temporary_folder.h"

namespace parhelion {
namespace {

using test::TemporaryFolder;
using Colour = std::array<int, 3>;

Image imageOf(const std::vector<glm::vec3>& pixels) {
    Image image{.size = {static_cast<unsigned>(pixels.size()), 1}, .channels = {}, .attributes = {}};
    for (int c = 0; c < 3; ++c)
        for (const glm::vec3& pixel : pixels) image.channels[std::string(1, "RGB"[c])].push_back(pixel[c]);
    return image;
}

/// The code values of a PNG, without a note on it.
std::vector<Colour> coloursIn(const std::filesystem::path& file) {
    const Bitmap bitmap = readBitmap(file, {}, BitmapEncoding::kRaw);
    EXPECT_TRUE(bitmap.notes.empty());
    std::vector<Colour> colours;
    for (const glm::vec3& texel : bitmap.texels) {
        const glm::ivec3 code = glm::ivec3(glm::round(texel * 255.0f));
        colours.push_back({code.r, code.g, code.b});
    }
    return colours;
}

std::vector<Colour> shownColours(const std::vector<glm::vec3>& pixels, double exposureStops = 0) {
    const TemporaryFolder folder;
    writePng(folder.path() / "a.png", imageOf(pixels), exposureStops);
    const std::vector<Colour> colours = coloursIn(folder.path() / "a.png");
    EXPECT_EQ(colours.size(), pixels.size());
    return colours;
}

TEST(ToneCurve, LeavesValuesUpToOneHalfUntouched) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 0.5);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 colour{uniform(random), uniform(random), uniform(random)};
        EXPECT_EQ(displayColour(colour), colour);
    }
}

TEST(ToneCurve, RisesSmoothlyTowardsWhite) {
    double before = displayColour(glm::dvec3(0.4)).g;
    for (double value = 0.401; value < 1e6; value *= 1.001) {
        const double shown = displayColour(glm::dvec3(value)).g;
        EXPECT_GT(shown, before);
        EXPECT_LE(shown, 1.0);
        before = shown;
    }
    // 1 - 1/(4p): same value and slope as the identity at 1/2; second derivative -4 there, so the error of the
    // difference quotient is 4 h.
    const double h = 1e-4;
    EXPECT_NEAR((displayColour(glm::dvec3(0.5 + h)).g - 0.5) / h, 1.0, 4 * h);
}

// Hue as the position of the middle channel between the outer two. Two steps scale and shift all channels alike, each
// with roundings of 2^-53: 1e-12 leaves room for hues of small chroma, down to 1e-3 of the peak.
TEST(ToneCurve, KeepsHueHoweverBright) {
    for (const double peak : {0.6, 1.0, 7.0, 1e3, 1e6}) {
        const glm::dvec3 shown = displayColour(peak * glm::dvec3(1.0, 0.25, 0.05));
        EXPECT_NEAR((shown.g - shown.b) / (shown.r - shown.b), (0.25 - 0.05) / (1.0 - 0.05), peak * 1e-12) << peak;
        EXPECT_LE(shown.r, 1.0);
    }
}

TEST(PngFile, ShowsKnownCodeValues) {
    // sRGB of 0.5 is 0.7354 -> 188, of 0.0031308 x 12.92 -> 10, of 1 - 1/4 = 0.75 is 0.8808 -> 225.
    const std::vector<Colour> shown = shownColours(
        {glm::vec3(0), glm::vec3(0.5f), glm::vec3(0.0031308f), glm::vec3(1), glm::vec3(0.5f, 0.0f, 0.25f)});
    EXPECT_EQ(shown[0], (Colour{0, 0, 0}));
    EXPECT_EQ(shown[1], (Colour{188, 188, 188}));
    EXPECT_EQ(shown[2], (Colour{10, 10, 10}));
    EXPECT_EQ(shown[3], (Colour{225, 225, 225}));
    EXPECT_EQ(shown[4], (Colour{188, 0, 137}));
}

TEST(PngFile, ExposureIsInStops) {
    EXPECT_EQ(shownColours({glm::vec3(0.1f)}, 2.0), shownColours({glm::vec3(0.4f)}));
    EXPECT_EQ(shownColours({glm::vec3(0.4f)}, -1.0), shownColours({glm::vec3(0.2f)}));
}

TEST(PngFile, MarksWhatIsNotFinite) {
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Colour> shown =
        shownColours({{infinity, 0, 0}, {nan, 0, 0}, {infinity, nan, 0}, {-1, 0.5f, -infinity}, {3e38f, 0, 0}}, 64);
    EXPECT_EQ(shown[0], (Colour{255, 255, 255}));
    EXPECT_EQ(shown[1], (Colour{255, 0, 255}));
    EXPECT_EQ(shown[2], (Colour{255, 0, 255}));
    EXPECT_EQ(shown[3], (Colour{255, 255, 255}));
    EXPECT_EQ(shown[4], (Colour{255, 255, 255}));
}

TEST(PngFile, RefusesMissingChannelsAndWildExposure) {
    const TemporaryFolder folder;
    const Image grey{.size = {1, 1}, .channels = {{"Y", {1.0f}}}, .attributes = {}};
    EXPECT_THROW(writePng(folder.path() / "a.png", grey), InputError);
    for (const double stops : {65.0, -65.0, std::nan(""), HUGE_VAL})
        EXPECT_THROW(writePng(folder.path() / "a.png", imageOf({glm::vec3(1)}), stops), InputError) << stops;
    EXPECT_TRUE(folder.names().empty());
}

TEST(SignedPng, ShowsSignAndSize) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "signed.png";
    const float nan = std::numeric_limits<float>::quiet_NaN();
    writeSignedPng(file, {6, 1}, std::vector<float>{0, 2, 9, -2, -1, nan}, 2.0);
    const std::vector<Colour> colours = coloursIn(file);
    ASSERT_EQ(colours.size(), 6u);
    const auto at = [&](std::size_t i) { return colours[i]; };
    EXPECT_EQ(at(0), (Colour{255, 255, 255}));
    EXPECT_GT(at(1)[0], at(1)[2] + 100);  // red
    EXPECT_EQ(at(2), at(1));              // beyond the range
    EXPECT_GT(at(3)[2], at(3)[0] + 100);  // blue
    EXPECT_GT(at(4)[0], at(3)[0]);        // half way to white
    EXPECT_GT(at(5)[1], at(5)[0] + 100);  // not a number: green
}

}  // namespace
}  // namespace parhelion
