// Damage of every kind to every volume format, in this process: a crash, a hang or a huge allocation fails the test.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

#include "support/temporary_folder.h"
#include "volume/grid_format.h"
#include "volume/volume_file.h"

namespace parhelion {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPositions = 200;
constexpr std::size_t kMemoryLimit = std::size_t(1) << 28;

/// Two bricks apart, one voxel on every border: 20 x 12 x 10.
Volume exampleVolume() {
    Volume volume;
    volume.density = DensityGrid({20, 12, 10});
    for (unsigned i = 0; i < 40; ++i) volume.density.set({i % 7, i % 5, i % 9}, 0.125f + float(i));
    volume.density.set({19, 11, 9}, 2.5f);
    return volume;
}

class VolumeDamage : public testing::TestWithParam<std::string> {
protected:
    std::string validBytes() {
        const fs::path file = folder_.path() / ("valid" + GetParam());
        writeVolume(file, exampleVolume());
        std::stringstream content;
        content << std::ifstream(file, std::ios::binary).rdbuf();
        return content.str();
    }

    /// True when the bytes are refused with an InputError that names the file. Accepted ones must be a sound volume.
    bool isRefused(const std::string& bytes) {
        const fs::path file = folder_.write("damaged" + GetParam(), bytes);
        VolumeReadOptions options;
        options.memoryLimitBytes = kMemoryLimit;
        try {
            const Volume volume = readVolume(file, {"scene.xml", 3, 4}, options);
            EXPECT_LE(volume.density.memoryBytes(), kMemoryLimit);
            for (const float value : volume.density.voxels()) EXPECT_TRUE(std::isfinite(value) && value >= 0);
            for (int axis = 0; axis < 3; ++axis) EXPECT_LT(volume.boundsMin[axis], volume.boundsMax[axis]);
            return false;
        } catch (const InputError& error) {
            EXPECT_EQ(std::string(error.what()).find(file.string()), 0u) << error.what();
            return true;
        }
    }

    test::TemporaryFolder folder_;
};

/// kPositions places spread over [0, size), the first 1000 bytes (headers) most densely.
std::vector<std::size_t> positions(std::size_t size) {
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < kPositions / 2; ++i) {
        result.push_back(i * std::min<std::size_t>(size, 1000) / (kPositions / 2));
        result.push_back(i * size / (kPositions / 2));
    }
    result.push_back(size - 1);
    return result;
}

TEST_P(VolumeDamage, UndamagedFileIsRead) { EXPECT_FALSE(isRefused(validBytes())); }

TEST_P(VolumeDamage, TruncationAnywhereIsRefused) {
    const std::string bytes = validBytes();
    for (const std::size_t length : positions(bytes.size()))
        EXPECT_TRUE(isRefused(bytes.substr(0, length))) << "cut to " << length << " of " << bytes.size() << " bytes";
}

TEST_P(VolumeDamage, BytesAfterTheEndAreRefused) { EXPECT_TRUE(isRefused(validBytes() + "and more")); }

TEST_P(VolumeDamage, AnySingleByteMayChangeWithoutACrash) {
    const std::string bytes = validBytes();
    for (const std::size_t position : positions(bytes.size())) {
        for (const int flip : {0xff, 0x80, 0x01}) {
            std::string damaged = bytes;
            damaged[position] = static_cast<char>(damaged[position] ^ flip);
            const bool refused = isRefused(damaged);
            // The checksum covers every byte; the other formats have none, so that some damage looks sound.
            EXPECT_TRUE(refused || GetParam() != ".grid") << "byte " << position << " xor " << flip;
        }
    }
}

TEST_P(VolumeDamage, EveryByteOfTheMagicCounts) {
    const std::string bytes = validBytes();
    const std::size_t magicBytes = GetParam() == ".vol" ? 4 : 8;
    for (std::size_t position = 0; position < magicBytes; ++position) {
        std::string damaged = bytes;
        damaged[position] ^= 0x55;
        EXPECT_TRUE(isRefused(damaged)) << "byte " << position;
    }
}

TEST_P(VolumeDamage, SeveralRandomChangesDoNotCrash) {
    const std::string bytes = validBytes();
    std::mt19937 random(17);
    for (std::size_t trial = 0; trial < kPositions; ++trial) {
        std::string damaged = bytes;
        for (int i = 0; i < 8; ++i) damaged[random() % damaged.size()] = static_cast<char>(random());
        isRefused(damaged);
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, VolumeDamage, testing::Values(".vol", ".grid", ".vdb", ".nvdb"),
                         [](const auto& info) { return info.param.substr(1); });

/// A .vol file of the given header fields and values.
std::string volBytes(glm::ivec3 resolution, int channels, const std::vector<float>& values, int type = 1) {
    std::string bytes = "VOL\3";
    const auto append = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
    append(type);
    append(resolution);
    append(channels);
    append(glm::vec3(0.0f));
    append(glm::vec3(1.0f));
    for (const float value : values) append(value);
    return bytes;
}

std::string errorOf(const std::string& bytes) {
    const test::TemporaryFolder folder;
    try {
        readVolume(folder.write("volume.bin", bytes), {"scene.xml", 3, 4});
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(VolumeInput, FirstBadVoxelIsNamed) {
    for (const float bad : {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        std::vector<float> values(2 * 3 * 4, 0.5f);
        values[(2 * 3 + 1) * 2 + 1] = bad;
        values.back() = bad;
        EXPECT_NE(errorOf(volBytes({2, 3, 4}, 1, values)).find("voxel (1, 1, 2)"), std::string::npos) << bad;
    }
    EXPECT_EQ(errorOf(volBytes({2, 3, 4}, 1, std::vector<float>(24, 0.5f))), "");
}

TEST(VolumeInput, BadVolHeadersAreRefused) {
    const std::vector<float> six(6, 0.5f);
    EXPECT_NE(errorOf(volBytes({1, 1, 1}, 6, six)).find("channels must be 1 or 3"), std::string::npos);
    EXPECT_NE(errorOf(volBytes({1, 2, 3}, 1, six, 2)).find("float32"), std::string::npos);
    for (const glm::ivec3 resolution : {glm::ivec3(0, 1, 1), glm::ivec3(-1, 1, 6), glm::ivec3(8193, 1, 1)})
        EXPECT_NE(errorOf(volBytes(resolution, 1, six)).find("resolution"), std::string::npos);
    EXPECT_NE(errorOf(volBytes({8192, 8192, 8192}, 3, six)).find("needs 6597069766656 bytes"), std::string::npos);
}

TEST(VolumeInput, HeaderOfAHugeGridIsRefusedWithoutTheMemory) {
    GridHeader header{};
    std::memcpy(header.magic, kGridMagic, sizeof(header.magic));
    header.version = kGridVersion;
    for (int axis = 0; axis < 3; ++axis) header.resolution[axis] = 2920, header.boundsMax[axis] = 1;
    header.channels = 1;
    header.scale = 1;
    header.payloadBytes = 2920ull * 2920 * 2920 * 4;  // 100 GB
    header.checksum = gridChecksum(header, {});
    std::string bytes(reinterpret_cast<const char*>(&header), sizeof(header));
    EXPECT_NE(errorOf(bytes).find("99588352000 bytes must follow"), std::string::npos) << errorOf(bytes);

    // The same grid without a brick: 12 MB of occupancy bits are there, the limit is what stops it.
    header.layout = GridLayout::kSparse;
    const std::string occupancy(occupancyBytes(365ull * 365 * 365), '\0');
    header.payloadBytes = occupancy.size();
    header.checksum = gridChecksum(header, std::as_bytes(std::span(occupancy)));
    bytes.assign(reinterpret_cast<const char*>(&header), sizeof(header));
    const test::TemporaryFolder folder;
    VolumeReadOptions options;
    options.memoryLimitBytes = 1'000'000;
    EXPECT_THROW(readVolume(folder.write("sparse.grid", bytes + occupancy), {}, options), InputError);
}

TEST(VolumeInput, SoundChecksumDoesNotExcuseAnUnsoundGridHeader) {
    const auto errorWith = [](auto change) {
        GridHeader header{};
        std::memcpy(header.magic, kGridMagic, sizeof(header.magic));
        header.version = kGridVersion;
        for (int axis = 0; axis < 3; ++axis) header.resolution[axis] = 2, header.boundsMax[axis] = 1;
        header.channels = 1;
        header.scale = 1;
        header.payloadBytes = 8 * sizeof(float);
        change(header);
        const std::string payload(8 * sizeof(float), '\0');
        header.checksum = gridChecksum(header, std::as_bytes(std::span(payload)));
        return errorOf(std::string(reinterpret_cast<const char*>(&header), sizeof(header)) + payload);
    };
    EXPECT_EQ(errorWith([](GridHeader&) {}), "");
    EXPECT_NE(errorWith([](GridHeader& h) { h.version = 2; }).find("version"), std::string::npos);
    EXPECT_NE(errorWith([](GridHeader& h) { h.boundsMax[1] = 0; }).find("bounds"), std::string::npos);
    EXPECT_NE(errorWith([](GridHeader& h) { h.boundsMin[0] = NAN; }).find("bounds"), std::string::npos);
    EXPECT_NE(errorWith([](GridHeader& h) { h.lattice = GridLattice(2); }).find("lattice"), std::string::npos);
    EXPECT_NE(errorWith([](GridHeader& h) { h.valueType = GridValueType(3); }).find("value type"), std::string::npos);
    EXPECT_NE(errorWith([](GridHeader& h) { h.channels = 2; }).find("channels"), std::string::npos);
    EXPECT_NE(errorWith([](GridHeader& h) { h.layout = GridLayout(2); }).find("layout"), std::string::npos);
    EXPECT_NE(errorWith([](GridHeader& h) { h.scale = 2; }).find("scale"), std::string::npos);
    EXPECT_NE(errorWith([](GridHeader& h) { h.brickCount = 1; }).find("brick count"), std::string::npos);
    EXPECT_NE(errorWith([](GridHeader& h) { h.resolution[2] = 3; }).find("payload"), std::string::npos);
    EXPECT_NE(errorWith([](GridHeader& h) { h.reserved = 1; }).find("reserved"), std::string::npos);
}

TEST(VolumeInput, NodeLatticeReachesHalfAVoxelBeyondItsBounds) {
    GridHeader header{};
    std::memcpy(header.magic, kGridMagic, sizeof(header.magic));
    header.version = kGridVersion;
    for (int axis = 0; axis < 3; ++axis) header.resolution[axis] = 3, header.boundsMax[axis] = 2;
    header.lattice = GridLattice::kNode;
    header.channels = 1;
    header.scale = 1;
    const std::string payload(27 * sizeof(float), '\0');
    header.payloadBytes = payload.size();
    header.checksum = gridChecksum(header, std::as_bytes(std::span(payload)));
    const test::TemporaryFolder folder;
    const fs::path file =
        folder.write("node.grid", std::string(reinterpret_cast<const char*>(&header), sizeof(header)) + payload);
    const Volume volume = readVolume(file, {});
    EXPECT_EQ(volume.boundsMin, glm::dvec3(-0.5));
    EXPECT_EQ(volume.boundsMax, glm::dvec3(2.5));
}

TEST(VolumeInput, ThingsThatAreNoVolumesAreRefused) {
    EXPECT_NE(errorOf("").find("not a volume file"), std::string::npos);
    EXPECT_NE(errorOf("<scene/>").find("not a volume file"), std::string::npos);
    EXPECT_NE(errorOf("VOL\2").find("version"), std::string::npos);
    EXPECT_THROW(readVolume("/dev/zero", {}), InputError);
    EXPECT_THROW(readVolume(fs::temp_directory_path(), {}), InputError);
}

}  // namespace
}  // namespace parhelion
