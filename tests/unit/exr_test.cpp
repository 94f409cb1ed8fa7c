#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>

#include "base/files.h"
#include "image/image.h"
#include "support/temporary_folder.h"

namespace parhelion {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

/// Every kind of float, in an odd size so that the last block of 16 lines is short.
Image everyKindOfFloat() {
    Image image{.size = {33, 21}, .channels = {}, .attributes = {}};
    std::mt19937 random(7);
    for (const char* name : {"R", "G", "B", "variance.R", "depth.Z", "sampleCount.Y"}) {
        std::vector<float>& values = image.channels[name];
        for (unsigned i = 0; i < 33 * 21; ++i) values.push_back(std::bit_cast<float>(std::uint32_t(random())));
    }
    using Limits = std::numeric_limits<float>;
    const std::vector<float> special{0.0f,
                                     -0.0f,
                                     Limits::infinity(),
                                     -Limits::infinity(),
                                     Limits::quiet_NaN(),
                                     Limits::denorm_min(),
                                     Limits::max(),
                                     Limits::lowest(),
                                     1.0f};
    std::copy(special.begin(), special.end(), image.channels["R"].begin());
    return image;
}

std::vector<std::uint32_t> bitsOf(const std::vector<float>& values) {
    std::vector<std::uint32_t> bits;
    for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
    return bits;
}

/// The message of the InputError that reading throws; empty if it throws none.
std::string readingError(const fs::path& file) {
    try {
        readExr(file);
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

TEST(ExrFile, RoundTripIsBitExact) {
    const TemporaryFolder folder;
    const Image written = everyKindOfFloat();
    writeExr(folder.path() / "a.exr", written);
    const Image read = readExr(folder.path() / "a.exr");
    EXPECT_EQ(read.size, written.size);
    ASSERT_EQ(read.channels.size(), written.channels.size());
    for (const auto& [name, values] : written.channels)
        EXPECT_EQ(bitsOf(read.channels.at(name)), bitsOf(values)) << name;
    EXPECT_EQ(folder.names(), std::set<std::string>{"a.exr"});
}

TEST(ExrFile, AttributesKeepTypeAndValue) {
    const TemporaryFolder folder;
    Image image{.size = {1, 1}, .channels = {{"Y", {1.0f}}}, .attributes = {}};
    image.attributes = {{"renderTimeSeconds", 0.1},
                        {"seed", std::int64_t{-2147483648}},
                        {"samplesPerPixel", std::int64_t{2147483647}},
                        {"aNameLongerThanTheThirtyOneBytesOfOldFiles", std::string("text\nof two lines")}};
    writeExr(folder.path() / "a.exr", image);
    EXPECT_EQ(readExr(folder.path() / "a.exr").attributes, image.attributes);
}

TEST(ExrFile, IntegersTooLargeForTheFormatBecomeText) {
    const TemporaryFolder folder;
    Image image{.size = {1, 1}, .channels = {{"Y", {1.0f}}}, .attributes = {{"samples", std::int64_t{1} << 40}}};
    writeExr(folder.path() / "a.exr", image);
    EXPECT_EQ(std::get<std::string>(readExr(folder.path() / "a.exr").attributes.at("samples")), "1099511627776");
}

TEST(ExrFile, SameImageGivesTheSameBytes) {
    const TemporaryFolder folder;
    writeExr(folder.path() / "a.exr", everyKindOfFloat());
    writeExr(folder.path() / "b.exr", everyKindOfFloat());
    EXPECT_EQ(readBinaryFile(folder.path() / "a.exr"), readBinaryFile(folder.path() / "b.exr"));
}

TEST(ExrFile, FailedWriteKeepsTheOldFile) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("a.exr", "old");
    const Image wrongLength{.size = {2, 2}, .channels = {{"R", {1.0f}}}, .attributes = {}};
    const Image wrongType{.size = {1, 1}, .channels = {{"R", {1.0f}}}, .attributes = {{"compression", 1.0}}};
    const Image empty;
    for (const Image* image : {&wrongLength, &wrongType, &empty}) EXPECT_THROW(writeExr(file, *image), RuntimeFailure);
    EXPECT_EQ(readTextFile(file), "old");
    EXPECT_EQ(folder.names(), std::set<std::string>{"a.exr"});
}

/// Half and uint channels in tiles with mipmaps, off the origin: x + 10 y and 1000 x + y, relative to the corner.
void writeTiled(const fs::path& file) {
    const Imath::Box2i window({-3, 5}, {36, 40});
    Imf::Header header(window, window);
    header.channels().insert("H", Imf::Channel(Imf::HALF));
    header.channels().insert("U", Imf::Channel(Imf::UINT));
    header.setTileDescription(Imf::TileDescription(16, 16, Imf::MIPMAP_LEVELS));
    std::vector<half> halves;
    std::vector<unsigned> integers;
    for (unsigned y = 0; y < 36; ++y)
        for (unsigned x = 0; x < 40; ++x) {
            halves.push_back(half(static_cast<float>(x + 10 * y)));
            integers.push_back(1000 * x + y);
        }
    Imf::TiledOutputFile output(file.c_str(), header);
    for (int level = 0; level < output.numLevels(); ++level) {
        Imf::FrameBuffer source;
        source.insert("H", Imf::Slice::Make(Imf::HALF, halves.data(), window, sizeof(half), sizeof(half) * 40));
        source.insert("U",
                      Imf::Slice::Make(Imf::UINT, integers.data(), window, sizeof(unsigned), sizeof(unsigned) * 40));
        output.setFrameBuffer(source);
        output.writeTiles(0, output.numXTiles(level) - 1, 0, output.numYTiles(level) - 1, level);
    }
}

TEST(ExrFile, ReadsTilesOfHalvesAndIntegersOffTheOrigin) {
    const TemporaryFolder folder;
    writeTiled(folder.path() / "tiled.exr");
    const Image image = readExr(folder.path() / "tiled.exr");
    ASSERT_EQ(image.size, glm::uvec2(40, 36));
    for (unsigned y = 0; y < 36; ++y)
        for (unsigned x = 0; x < 40; ++x) {
            EXPECT_EQ(image.channels.at("H")[y * 40 + x], static_cast<float>(x + 10 * y));
            EXPECT_EQ(image.channels.at("U")[y * 40 + x], static_cast<float>(1000 * x + y));
        }
}

TEST(ExrFile, RefusesSeveralParts) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "parts.exr";
    std::vector<Imf::Header> headers(2, Imf::Header(4, 4));
    for (int part = 0; part < 2; ++part) {
        headers[part].setName(std::to_string(part));
        headers[part].setType(Imf::SCANLINEIMAGE);
        headers[part].channels().insert("R", Imf::Channel(Imf::FLOAT));
    }
    { Imf::MultiPartOutputFile output(file.c_str(), headers.data(), 2); }
    EXPECT_NE(readingError(file).find("must have one part; got 2"), std::string::npos) << readingError(file);
}

TEST(ExrFile, RefusesDeepPixels) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "deep.exr";
    Imf::Header header(4, 4);
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    { Imf::DeepScanLineOutputFile output(file.c_str(), header); }
    EXPECT_NE(readingError(file).find("must hold flat pixels"), std::string::npos) << readingError(file);
}

TEST(ExrFile, RefusesSubsampledChannels) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "chroma.exr";
    Imf::Header header(4, 4);
    header.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
    { Imf::OutputFile output(file.c_str(), header); }
    EXPECT_NE(readingError(file).find("sampled at every pixel; got 'RY' at every 2 x 2"), std::string::npos)
        << readingError(file);
}

TEST(ExrFile, RefusesAnImageLargerThanMemory) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "huge.exr";
    Imf::Header header(4, 4);
    header.dataWindow() = Imath::Box2i({0, 0}, {50'000'000, 20'000});
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    { Imf::OutputFile output(file.c_str(), header); }
    EXPECT_NE(readingError(file).find("fit into half of the memory"), std::string::npos) << readingError(file);
}

TEST(ExrFile, NamesAMissingFileAndAFolder) {
    const TemporaryFolder folder;
    EXPECT_NE(readingError(folder.path() / "none.exr").find("file must exist"), std::string::npos);
    EXPECT_NE(readingError(folder.path()).find("must be a regular file"), std::string::npos);
}

TEST(ExrFile, EveryTruncationIsAnInputError) {
    const TemporaryFolder folder;
    writeExr(folder.path() / "whole.exr", everyKindOfFloat());
    const std::string whole = readTextFile(folder.path() / "whole.exr");
    for (std::size_t length = 0; length < whole.size(); length += 1 + length / 16) {
        const fs::path file = folder.write("short.exr", whole.substr(0, length));
        EXPECT_NE(readingError(file), "") << length << " of " << whole.size() << " bytes";
    }
}

// Damage may go unnoticed (the format has no checksum of raw floats) but must never crash or throw anything else.
TEST(ExrFile, DamagedBytesAreAnInputErrorOrAnImage) {
    const TemporaryFolder folder;
    Image image = everyKindOfFloat();
    writeExr(folder.path() / "whole.exr", image);
    const std::string whole = readTextFile(folder.path() / "whole.exr");
    std::mt19937 random(11);
    std::size_t refused = 0;
    for (int trial = 0; trial < 600; ++trial) {
        std::string damaged = whole;
        // Half of the trials aim at the header and the offset table.
        const std::size_t reach = trial % 2 == 0 ? 700 : whole.size();
        for (int k = 0; k < 3; ++k) damaged[random() % reach] = static_cast<char>(random());
        refused += !readingError(folder.write("damaged.exr", damaged)).empty();
    }
    EXPECT_GT(refused, 100u);
}

}  // namespace
}  // namespace parhelion
