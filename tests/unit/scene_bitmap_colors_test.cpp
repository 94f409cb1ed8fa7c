// Colours of EXR files in spaces other than Rec. 709, against what Mitsuba 3.9.1 makes of the same files.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include "image/bitmap.h"
#include "support/temporary_folder.h"

namespace parhelion::test {
namespace {

using Channels = std::map<std::string, float>;
using Imath::V2f;

const Imf::Chromaticities kDisplayP3({0.68f, 0.32f}, {0.265f, 0.69f}, {0.15f, 0.06f}, {0.3127f, 0.329f});
const Imf::Chromaticities kAces({0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f}, {0.32168f, 0.33767f});
const Imf::Chromaticities kRec709WithWhiteE({0.64f, 0.33f}, {0.3f, 0.6f}, {0.15f, 0.06f}, {1 / 3.0f, 1 / 3.0f});
const Imf::Chromaticities kXyz({1, 0}, {0, 1}, {0, 0}, {1 / 3.0f, 1 / 3.0f});

/// The colour of a bitmap of one texel.
glm::vec3 colorOf(const Channels& channels, const Imf::Chromaticities* space = nullptr) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "texel.exr";
    {
        Imf::Header header(1, 1);
        if (space) Imf::addChromaticities(header, *space);
        Imf::FrameBuffer source;
        for (const auto& [name, value] : channels) {
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            source.insert(name, Imf::Slice(Imf::FLOAT, (char*)&value, sizeof(float), sizeof(float)));
        }
        Imf::OutputFile output(file.c_str(), header);
        output.setFrameBuffer(source);
        output.writePixels(1);
    }
    return readBitmap(file, {}).texels.at(0);
}

void expectColor(const glm::vec3& actual, const glm::vec3& expected) {
    constexpr float kPrinted = 2e-6f;  // Mitsuba's, in single precision, were printed with six decimals
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], kPrinted) << i;
}

const Channels kRgb{{"R", 0.4f}, {"G", 0.5f}, {"B", 0.6f}};
const Channels kXyzTexel{{"X", 0.4f}, {"Y", 0.5f}, {"Z", 0.6f}};
const Channels kChroma{{"Y", 0.5f}, {"RY", 0.2f}, {"BY", -0.1f}};

TEST(ExrColors, AreConvertedFromThePrimariesOfTheFile) {
    const Imf::Chromaticities rec709;
    EXPECT_EQ(colorOf(kRgb), glm::vec3(0.4f, 0.5f, 0.6f));
    EXPECT_EQ(colorOf(kRgb, &rec709), glm::vec3(0.4f, 0.5f, 0.6f));
    expectColor(colorOf(kRgb, &kDisplayP3), {0.377506f, 0.504206f, 0.611791f});
    expectColor(colorOf(kRgb, &kAces), {0.228532f, 0.515721f, 0.567478f});
    expectColor(colorOf(kRgb, &kRec709WithWhiteE), {0.48199f, 0.474139f, 0.545175f});
    expectColor(colorOf(kRgb, &kXyz), {0.228496f, 0.575227f, 0.554625f});
}

TEST(ExrColors, MayBeXyzWhateverThePrimaries) {
    expectColor(colorOf(kXyzTexel), {0.228496f, 0.575227f, 0.554625f});
    expectColor(colorOf(kXyzTexel, &kDisplayP3), {0.228496f, 0.575227f, 0.554625f});
}

TEST(ExrColors, MayBeLuminanceAndChroma) {
    expectColor(colorOf(kChroma), {0.6f, 0.475315f, 0.45f});
    expectColor(colorOf(kChroma, &kDisplayP3), {0.628651f, 0.467273f, 0.445275f});
    EXPECT_EQ(colorOf({{"Y", 0.5f}}, &kDisplayP3), glm::vec3(0.5f));
}

TEST(ExrColors, NeedPrimariesThatSpanThem) {
    const Imf::Chromaticities line({0.1f, 0.1f}, {0.2f, 0.2f}, {0.3f, 0.3f}, {0.3f, 0.3f});
    EXPECT_THROW(colorOf(kRgb, &line), InputError);
}

}  // namespace
}  // namespace parhelion::test
