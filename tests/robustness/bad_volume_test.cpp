// Damaged and hostile volume files: a message that names the file, exit code 2, no memory taken, nothing written.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include "support/paths.h"
#include "support/run_program.h"
#include "support/scene_text.h"
#include "volume/volume_file.h"

namespace parhelion::test {
namespace {

namespace fs = std::filesystem;

/// A tiny scene takes 40 MiB until a device is opened; a grid of 100 GB cannot hide below this.
constexpr long kPeakMemoryKiB = 1024 * 1024;

Volume ball() {
    constexpr unsigned kSize = 20;
    Volume volume;
    volume.density = DensityGrid(glm::uvec3(kSize));
    for (unsigned z = 0; z < kSize; ++z)
        for (unsigned y = 0; y < kSize; ++y)
            for (unsigned x = 0; x < kSize; ++x)
                if (glm::distance(glm::vec3(x, y, z), glm::vec3(10)) < 7)
                    volume.density.set({x, y, z}, 0.5f + 0.01f * x);
    return volume;
}

std::string contentOf(const fs::path& file) {
    std::stringstream content;
    content << std::ifstream(file, std::ios::binary).rdbuf();
    return content.str();
}

/// The bytes of a valid volume file.
std::string validBytes(const std::string& extension) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / ("ball" + extension);
    writeVolume(file, ball());
    return contentOf(file);
}

/// Renders a scene that reads `file`, in `folder`.
ProgramResult renderVolume(const TemporaryFolder& folder, const std::string& file) {
    SceneText scene;
    scene.medium = gridMedium(file);
    folder.write("scene.xml", scene.text());
    return runProgram(test::programFile(), {"render", "scene.xml"}, folder.path());
}

void expectRefused(const TemporaryFolder& folder, const std::string& file, const std::string& mentions) {
    const ProgramResult result = renderVolume(folder, file);
    EXPECT_EQ(result.exitCode, 2) << result.error;
    EXPECT_EQ(result.error.rfind("parhelion: error: ", 0), 0u) << result.error;
    EXPECT_NE(result.error.find(file), std::string::npos) << result.error;
    EXPECT_NE(result.error.find(mentions), std::string::npos) << result.error;
    EXPECT_LT(result.peakMemoryKiB, kPeakMemoryKiB);
    EXPECT_EQ(folder.names(), (std::set<std::string>{"scene.xml", file}));
}

/// A Mitsuba .vol header (48 bytes).
std::string volHeader(std::int32_t x, std::int32_t y, std::int32_t z) {
    std::string bytes("VOL\3", 4);
    const std::int32_t integers[] = {1, x, y, z, 1};
    const float bounds[] = {0, 0, 0, 1, 1, 1};
    bytes.append(reinterpret_cast<const char*>(integers), sizeof integers);
    bytes.append(reinterpret_cast<const char*>(bounds), sizeof bounds);
    return bytes;
}

/// The .vol of a 2x2x2 grid whose voxel (1, 0, 1) has this value.
std::string volWith(float value) {
    float values[8] = {1, 1, 1, 1, 1, value, 1, 1};
    return volHeader(2, 2, 2).append(reinterpret_cast<const char*>(values), sizeof values);
}

class VolumeFormat : public testing::TestWithParam<std::string> {};

TEST_P(VolumeFormat, ReadsWhatItWrote) {
    // The control for the tests below.
    const TemporaryFolder folder;
    const std::string file = "ball" + GetParam();
    folder.write(file, validBytes(GetParam()));
    SceneText scene;
    scene.medium = gridMedium(file);
    folder.write("scene.xml", scene.text());
    const ProgramResult result = runProgram(test::programFile(), {"inspect", "scene.xml"}, folder.path());
    EXPECT_EQ(result.exitCode, 0) << result.error;
}

TEST_P(VolumeFormat, TruncatedAnywhereIsRefused) {
    const std::string bytes = validBytes(GetParam());
    const std::string file = "cut" + GetParam();
    const std::size_t size = bytes.size();
    for (const std::size_t length : {std::size_t{0}, std::size_t{1}, std::size_t{9}, std::size_t{47}, std::size_t{100},
                                     size / 4, size / 2, size - size / 8, size - 1}) {
        SCOPED_TRACE(testing::Message() << length << " of " << size << " bytes");
        const TemporaryFolder folder;
        folder.write(file, bytes.substr(0, length));
        expectRefused(folder, file, "");
    }
}

TEST_P(VolumeFormat, DamagedNeverCrashes) {
    // A changed byte may leave a valid file: then it is read. Anything else is refused.
    std::string bytes = validBytes(GetParam());
    const std::string file = "damaged" + GetParam();
    for (int trial = 0; trial < 24; ++trial) {
        // Squaring puts most of the damage into headers and trees, where sizes and offsets are.
        const double fraction = (trial + 0.5) / 24;
        const auto at = static_cast<std::size_t>(fraction * fraction * static_cast<double>(bytes.size()));
        SCOPED_TRACE(testing::Message() << "byte " << at << " of " << bytes.size());
        std::string damaged = bytes;
        damaged[at] = static_cast<char>(damaged[at] ^ 0xa5);
        const TemporaryFolder folder;
        folder.write(file, damaged);
        SceneText scene;
        scene.medium = gridMedium(file);
        folder.write("scene.xml", scene.text());
        const ProgramResult result = runProgram(test::programFile(), {"inspect", "scene.xml"}, folder.path());
        EXPECT_TRUE(result.exitCode == 0 || result.exitCode == 2) << result.exitCode << "\n" << result.error;
        EXPECT_LT(result.peakMemoryKiB, kPeakMemoryKiB);
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, VolumeFormat, testing::Values(".vol", ".grid", ".vdb", ".nvdb"),
                         [](const auto& info) { return info.param.substr(1); });

TEST(VolumeValue, NanIsRefusedWithItsVoxel) {
    const TemporaryFolder folder;
    folder.write("bad.vol", volWith(std::numeric_limits<float>::quiet_NaN()));
    expectRefused(folder, "bad.vol", "(1, 0, 1)");
}

TEST(VolumeValue, InfinityIsRefusedWithItsVoxel) {
    const TemporaryFolder folder;
    folder.write("bad.vol", volWith(std::numeric_limits<float>::infinity()));
    expectRefused(folder, "bad.vol", "(1, 0, 1)");
}

TEST(VolumeValue, NegativeIsRefusedWithItsVoxel) {
    const TemporaryFolder folder;
    folder.write("bad.vol", volWith(-0.25f));
    expectRefused(folder, "bad.vol", "-0.25");
}

TEST(VolumeHeader, HugeSizesInAShortFileAreRefused) {
    // 3000^3 floats are 108 GB; the others overflow 32 or 64 bits when multiplied carelessly.
    for (const std::int32_t size : {3000, 65536, 2147483647, 0, -1}) {
        SCOPED_TRACE(size);
        const TemporaryFolder folder;
        folder.write("huge.vol", volHeader(size, size, size));
        expectRefused(folder, "huge.vol", "");
    }
}

TEST(VolumeHeader, HugeFileIsRefusedBeforeMemoryIsTaken) {
    const TemporaryFolder folder;
    folder.write("huge.vol", volHeader(3000, 3000, 3000));
    std::error_code error;
    fs::resize_file(folder.path() / "huge.vol", 48 + std::uintmax_t{3000} * 3000 * 3000 * 4, error);  // sparse
    if (error) GTEST_SKIP() << "the file system has no sparse files of 108 GB: " << error.message();
    expectRefused(folder, "huge.vol", "memory");
}

TEST(VolumeFile, UnknownContentIsRefused) {
    const TemporaryFolder folder;
    folder.write("text.vol", "this is no volume, whatever its name says, and it is long enough for every header\n");
    expectRefused(folder, "text.vol", ".vdb");
}

}  // namespace
}  // namespace parhelion::test
