// EXR bitmaps as other programs write them: layers, windows, whole numbers, cube maps, lossy compression.
#include <ImfChannelList.h>
#include <ImfEnvmapAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <limits>

#include "support/bitmap_reading.h"
#include "support/scene_reading.h"

namespace parhelion::test {
namespace {

using Channels = std::map<std::string, std::vector<float>>;

/// Writes channels of halves into `header`'s data window; those in `integers` as whole numbers.
void writeHalves(const std::filesystem::path& file, Imf::Header header, const Channels& channels,
                 const std::set<std::string>& integers = {}) {
    const Imath::Box2i window = header.dataWindow();
    const std::size_t width = std::size_t(window.max.x - window.min.x + 1);
    std::map<std::string, std::vector<half>> halves;
    std::map<std::string, std::vector<unsigned>> numbers;
    Imf::FrameBuffer source;
    for (const auto& [name, values] : channels)
        if (integers.contains(name)) {
            numbers[name].assign(values.begin(), values.end());
            header.channels().insert(name, Imf::Channel(Imf::UINT));
            source.insert(name, Imf::Slice::Make(Imf::UINT, numbers[name].data(), window, sizeof(unsigned),
                                                 sizeof(unsigned) * width));
        } else {
            for (const float value : values) halves[name].push_back(half(value));
            header.channels().insert(name, Imf::Channel(Imf::HALF));
            source.insert(name,
                          Imf::Slice::Make(Imf::HALF, halves[name].data(), window, sizeof(half), sizeof(half) * width));
        }
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(source);
    output.writePixels(window.max.y - window.min.y + 1);
}

/// Reads a bitmap of 2 x 1.
Bitmap read(const Channels& channels, const Imf::Header& header = Imf::Header(2, 1),
            const std::set<std::string>& integers = {}) {
    const TemporaryFolder folder;
    writeHalves(folder.path() / "picture.exr", header, channels, integers);
    return readBitmap(folder.path() / "picture.exr", {});
}

std::string errorOf(const Channels& channels, const Imf::Header& header = Imf::Header(2, 1)) {
    try {
        read(channels, header);
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

Channels rgb(const std::string& layer = "") {
    return {{layer + "R", {1, 2}}, {layer + "G", {3, 4}}, {layer + "B", {5, 6}}};
}

Channels operator+(Channels a, const Channels& b) {
    a.insert(b.begin(), b.end());
    return a;
}

TEST(ExrChannels, OfTheOnlyLayerAreTaken) {
    const Bitmap bitmap = read(rgb("beauty."));
    EXPECT_EQ(bitmap.texels[1], glm::vec3(2, 4, 6));
    EXPECT_NE(notesOf(bitmap).find("colours are those of the layer \"beauty\""), std::string::npos);
    EXPECT_EQ(read({{"r", {1, 2}}, {"g", {3, 4}}, {"b", {5, 6}}}).texels[1], glm::vec3(2, 4, 6));
    EXPECT_EQ(read({{"left.beauty.Y", {1, 2}}}).texels[1], glm::vec3(2));
}

TEST(ExrChannels, OfSeveralLayersAreRefusedUnlessSomeHaveNone) {
    EXPECT_NE(errorOf(rgb("diffuse.") + rgb("specular.")).find("got them in the layers diffuse, specular"),
              std::string::npos);
    const Bitmap bitmap = read(rgb() + rgb("specular.") + Channels{{"A", {1, 1}}});
    EXPECT_EQ(bitmap.texels[0], glm::vec3(1, 3, 5));
    EXPECT_NE(notesOf(bitmap).find("3 further channels are not used: specular.B, specular.G, specular.R"),
              std::string::npos)
        << notesOf(bitmap);
    EXPECT_EQ(notesOf(read(rgb() + Channels{{"A", {0, 1}}})), "");
}

TEST(ExrChannels, OfWholeNumbersAreTakenAsTheyAre) {
    const Bitmap bitmap = read(rgb(), Imf::Header(2, 1), {"G"});
    EXPECT_EQ(bitmap.texels[1], glm::vec3(2, 4, 6));
    EXPECT_NE(notesOf(bitmap).find("channel G holds whole numbers"), std::string::npos);
}

TEST(ExrWindows, ThatDifferAreNoted) {
    Imf::Header header(2, 1);
    header.displayWindow() = Imath::Box2i({0, 0}, {9, 4});
    header.dataWindow() = Imath::Box2i({3, 2}, {4, 2});
    const Bitmap bitmap = read(rgb(), header);
    EXPECT_EQ(bitmap.size, glm::uvec2(2, 1));
    EXPECT_NE(notesOf(bitmap).find("data window, (3, 2) to (4, 2); the display window, (0, 0) to (9, 4)"),
              std::string::npos)
        << notesOf(bitmap);
    EXPECT_NE(notesOf(read(rgb(), Imf::Header(2, 1, 2.0f))).find("\"pixelAspectRatio\" 2 has no effect"),
              std::string::npos);
}

/// A scene under a map of that size and layout, in either dialect; returns its notes.
std::vector<std::string> readUnder(const glm::uvec2& size, std::optional<Imf::Envmap> layout, bool isNori) {
    const TemporaryFolder folder;
    Imf::Header header(int(size.x), int(size.y));
    if (layout) Imf::addEnvmap(header, *layout);
    const std::vector<float> ones(size.x * size.y, 1.0f);
    writeHalves(folder.path() / "map.exr", header, {{"R", ones}, {"G", ones}, {"B", ones}});
    const std::string map = "<emitter type=\"envmap\">\n <string name=\"filename\" value=\"map.exr\"/></emitter>";
    const std::string scene =
        isNori ? "<scene><integrator type=\"path_mis\"/><camera type=\"perspective\"/>\n" + map + "</scene>"
               : sceneOf(map);
    return readScene(folder.write("scene.xml", scene)).notes;
}

TEST(ExrEnvironments, OfCubesAreRefusedWithTheirPlace) {
    for (const bool isNori : {false, true}) {
        EXPECT_TRUE(readUnder({8, 4}, Imf::ENVMAP_LATLONG, isNori).empty());
        try {
            readUnder({4, 24}, Imf::ENVMAP_CUBE, isNori);
            ADD_FAILURE() << "a cube map was accepted";
        } catch (const InputError& error) {
            const std::string text = error.what();
            EXPECT_NE(text.find("scene.xml:3:"), std::string::npos) << text;
            EXPECT_NE(text.find("says: cube map"), std::string::npos) << text;
        }
    }
}

TEST(ExrEnvironments, OfTheShapeOfCubesAreNoted) {
    for (const glm::uvec2 size : {glm::uvec2(8, 48), glm::uvec2(48, 8), glm::uvec2(32, 24), glm::uvec2(24, 32)}) {
        const std::vector<std::string> notes = readUnder(size, std::nullopt, false);
        ASSERT_EQ(notes.size(), 1u) << size.x;
        EXPECT_NE(notes[0].find("has the shape of the faces of a cube"), std::string::npos) << notes[0];
        EXPECT_TRUE(readUnder(size, Imf::ENVMAP_LATLONG, false).empty());
    }
    EXPECT_TRUE(readUnder({32, 16}, std::nullopt, false).empty());
}

/// A bitmap of 32 x 32 ones with two values changed.
std::string errorWith(float first, float second, std::string* notes = nullptr) {
    std::vector<float> values(32 * 32, 1.0f);
    values[5 * 32 + 7] = first;
    values[9 * 32 + 1] = second;
    try {
        const Bitmap bitmap = read({{"R", values}, {"G", values}, {"B", values}}, Imf::Header(32, 32));
        if (notes) *notes = notesOf(bitmap);
        EXPECT_EQ(bitmap.at(7, 5).g, std::max(first, 0.0f));
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

// The largest texel is 1, the limit 1/510 = .00196.
TEST(NegativeTexels, AreBlackWhereTheyAreNegligible) {
    std::string notes;
    EXPECT_EQ(errorWith(-4.7e-6f, 1.0f, &notes), "");
    EXPECT_NE(notes.find("3 negative values, down to -4.71e-06 (4.7e-06 of the largest), are taken for 0"),
              std::string::npos)
        << notes;
    EXPECT_EQ(errorWith(-0.0019f, -1e-7f), "");
    EXPECT_NE(errorWith(-1e-7f, -0.0021f).find("6 values are negative, down to -0.0021; got -0.002"), std::string::npos)
        << errorWith(-1e-7f, -0.0021f);
    EXPECT_NE(errorWith(1.0f, -0.5f).find("got -0.5 in channel R at column 1, row 9"), std::string::npos);
    EXPECT_EQ(errorWith(-0.0f, 1.0f, &notes), "");
    EXPECT_EQ(notes, "");
}

// A fifth at -.0015 is 1 / 2667 of the light; half of the texels at that value are 1 / 667.
TEST(NegativeTexels, AreRefusedWhereTheyAreTooManyToBeNegligible) {
    for (const int period : {5, 2}) {
        std::vector<float> values(40 * 40, 1.0f);
        for (std::size_t i = 0; i < values.size(); i += std::size_t(period)) values[i] = -0.0015f;
        const Channels channels{{"R", values}, {"G", values}, {"B", values}};
        const std::string error = errorOf(channels, Imf::Header(40, 40));
        EXPECT_EQ(error.find("together no further below 0 than 1/2048 of all the light") != std::string::npos,
                  period == 2)
            << error;
        EXPECT_EQ(error.empty(), period == 5) << error;
    }
    EXPECT_NE(errorOf({{"Y", {-1e-6f, 0}}}).find("texels must be finite and >= 0"), std::string::npos);
}

/// Noise on black beside a bright disc, which discrete cosines overshoot at.
TEST(NegativeTexels, OfLossyCompressionAreBlack) {
    std::vector<float> values(64 * 64);
    for (unsigned i = 0; i < values.size(); ++i) {
        const int x = int(i % 64) - 20, y = int(i / 64) - 20;
        values[i] = x * x + y * y < 30 ? 50.0f : i % 5 == 0 ? float(i % 97) / 200.0f : 0.0f;
    }
    Imf::Header header(64, 64);
    header.compression() = Imf::DWAA_COMPRESSION;
    const Bitmap bitmap = read({{"R", values}, {"G", values}, {"B", values}}, header);
    EXPECT_NE(notesOf(bitmap).find("negative values, down to"), std::string::npos);
    for (const glm::vec3& texel : bitmap.texels) EXPECT_TRUE(texel.r >= 0 && texel.g >= 0 && texel.b >= 0);
}

// Room for 8 million columns would be a gigabyte, and the file has no pixels at all.
TEST(ExrWindows, OfAbsurdSizesAreRefusedBeforeThereIsRoomForThem) {
    const TemporaryFolder folder;
    Imf::Header header(8388608, 18);
    header.channels().insert("Y", Imf::Channel(Imf::HALF));
    { Imf::OutputFile output((folder.path() / "wide.exr").c_str(), header); }
    try {
        readBitmap(folder.path() / "wide.exr", {});
        ADD_FAILURE() << "was read";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("at most 65536 texels a side; got 8388608 x 18"), std::string::npos)
            << error.what();
    }
}

TEST(InfiniteTexels, AreCountedAndTheFirstNamed) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const std::string error = errorOf({{"R", {1, kInfinity}}, {"G", {1, 1}}, {"B", {1, std::nanf("")}}});
    EXPECT_NE(error.find("2 values are not finite, the first; got inf in channel R at column 1, row 0"),
              std::string::npos)
        << error;
    EXPECT_NE(errorOf({{"Y", {1e6f, 1}}}).find("not finite"), std::string::npos);  // beyond the range of halves
}

}  // namespace
}  // namespace parhelion::test
