#include "volume/volume_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/paths.h"
#include "support/temporary_folder.h"

namespace parhelion {
namespace {

namespace fs = std::filesystem;

const fs::path kShared = fs::path(test::projectFolder()) / "../shared";
const std::vector<std::string> kExtensions{".vol", ".grid", ".vdb", ".nvdb"};

class VolumeFile : public testing::Test {
protected:
    fs::path path(const std::string& name) const { return folder_.path() / name; }

    Volume writeAndRead(const Volume& volume, const std::string& extension, const VolumeWriteOptions& options = {}) {
        const fs::path file = path("volume" + extension);
        writeVolume(file, volume, options);
        return readVolume(file, {"scene.xml", 1, 1});
    }

    test::TemporaryFolder folder_;
};

/// Two blobs far from each other and from the borders: bricks of zeros, and borders without a non-zero voxel.
Volume sparseVolume(glm::uvec3 resolution) {
    std::mt19937 random(7);
    Volume volume;
    volume.density = DensityGrid(resolution);
    for (const glm::uvec3 blob : {resolution / 4u, resolution * 3u / 4u})
        for (int i = 0; i < 100; ++i) {
            const glm::uvec3 offset(random() % 3, random() % 3, random() % 3);
            volume.density.set(glm::min(blob + offset, resolution - 1u), std::ldexp(float(random()), -20));
        }
    volume.boundsMin = {-1.25, 0.5, 3.0};
    volume.boundsMax = {2.0, 0.75, 10.5};
    return volume;
}

void expectSameField(const Volume& actual, const Volume& expected) {
    ASSERT_EQ(actual.channels, expected.channels);
    ASSERT_EQ(actual.density.resolution(), expected.density.resolution());
    EXPECT_EQ(actual.density.toDense(), expected.density.toDense());  // bit-exact: no value is -0 or NaN
    for (int axis = 0; axis < 3; ++axis) {
        // .vol rounds bounds to float32; .vdb and .nvdb rebuild them from voxel size and origin in double.
        const double scale = std::max(std::abs(expected.boundsMin[axis]), std::abs(expected.boundsMax[axis]));
        EXPECT_NEAR(actual.boundsMin[axis], expected.boundsMin[axis], 0x1p-24 * scale);
        EXPECT_NEAR(actual.boundsMax[axis], expected.boundsMax[axis], 0x1p-24 * scale);
    }
}

TEST_F(VolumeFile, EveryFormatKeepsSparseGridsBitExactly) {
    for (const glm::uvec3 resolution :
         {glm::uvec3(1), glm::uvec3(1, 9, 17), glm::uvec3(20, 1, 5), glm::uvec3(70, 35, 50), glm::uvec3(8, 16, 24)}) {
        const Volume volume = sparseVolume(resolution);
        for (const std::string& extension : kExtensions) {
            SCOPED_TRACE(extension + " " + std::to_string(resolution.x));
            const Volume copy = writeAndRead(volume, extension);
            expectSameField(copy, volume);
            EXPECT_EQ(copy.note, "");
            EXPECT_EQ(copy.density.voxels().size(), volume.density.voxels().size()) << "sparsity is lost";
        }
    }
}

TEST_F(VolumeFile, EveryFormatKeepsAnAllZeroGrid) {
    Volume volume;
    volume.density = DensityGrid({9, 10, 11});
    for (const std::string& extension : kExtensions) {
        SCOPED_TRACE(extension);
        expectSameField(writeAndRead(volume, extension), volume);
    }
}

TEST_F(VolumeFile, ChainOfAllFormatsKeepsSmallestAndLargestFloats) {
    Volume volume;
    volume.density = DensityGrid({3, 2, 1});
    volume.density.set({0, 0, 0}, 0x1p-149f);
    volume.density.set({1, 1, 0}, 0x1.fffffep127f);
    volume.density.set({2, 1, 0}, 1.0f / 3.0f);
    Volume copy = volume;
    for (const std::string& extension : kExtensions) copy = writeAndRead(copy, extension);
    expectSameField(copy, volume);
}

TEST_F(VolumeFile, ThreeChannelsSurviveInVolAndGrid) {
    Volume volume;
    volume.channels = 3;
    volume.color = {{3, 4, 5}, std::vector<float>(180)};
    for (std::size_t i = 0; i < 180; ++i) volume.color.values[i] = float(i) / 180.0f;
    for (const std::string extension : {".vol", ".grid"}) {
        const Volume copy = writeAndRead(volume, extension);
        EXPECT_EQ(copy.channels, 3u);
        EXPECT_EQ(copy.color.resolution, volume.color.resolution);
        EXPECT_EQ(copy.color.values, volume.color.values);
    }
    EXPECT_THROW(writeVolume(path("color.vdb"), volume), InputError);
    EXPECT_THROW(writeVolume(path("color.nvdb"), volume), InputError);
}

TEST_F(VolumeFile, GridValueTypesStayWithinTheirErrors) {
    const Volume volume = sparseVolume({20, 21, 22});
    const float largest = volume.density.maximum();
    const std::vector<float> exact = volume.density.toDense();
    const auto half = writeAndRead(volume, ".grid", {GridValueType::kFloat16}).density.toDense();
    const auto byte = writeAndRead(volume, ".grid", {GridValueType::kUnorm8}).density.toDense();
    for (std::size_t i = 0; i < exact.size(); ++i) {
        // 11 significant bits, and the half format's smallest step 2^-24 below its normal range.
        ASSERT_NEAR(half[i], exact[i], std::max(0x1p-11f * exact[i], 0x1p-25f));
        // Half a step, and the rounding of two float operations.
        ASSERT_NEAR(byte[i], exact[i], largest / 510 + 2 * 0x1p-24f * largest);
    }
    EXPECT_THROW(writeVolume(path("half.vol"), volume, {GridValueType::kFloat16}), InputError);
    Volume bright = volume;
    bright.density.set({0, 0, 0}, 70000.0f);
    EXPECT_THROW(writeVolume(path("half.grid"), bright, {GridValueType::kFloat16}), InputError);
    EXPECT_FALSE(fs::exists(path("half.grid"))) << "a refused write must leave nothing";
}

TEST_F(VolumeFile, FormatIsToldByContentNotByName) {
    const Volume volume = sparseVolume({10, 10, 10});
    for (const std::string& extension : kExtensions) {
        writeVolume(path("volume" + extension), volume);
        fs::rename(path("volume" + extension), path("volume.dat"));
        expectSameField(readVolume(path("volume.dat"), {}), volume);
    }
}

TEST_F(VolumeFile, UnknownExtensionAndMissingFileAreInputErrors) {
    EXPECT_THROW(writeVolume(path("volume.png"), sparseVolume({2, 2, 2})), InputError);
    try {
        readVolume(path("missing.vol"), {"scene.xml", 12, 5});
        FAIL() << "a missing file must be an error";
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find("scene.xml:12:5: "), 0u) << error.what();
    }
}

TEST_F(VolumeFile, MemoryLimitRefusesWithNeedAndAllowance) {
    const Volume volume = sparseVolume({70, 35, 50});
    for (const std::string& extension : kExtensions) {
        const fs::path file = path("volume" + extension);
        writeVolume(file, volume);
        VolumeReadOptions options;
        options.memoryLimitBytes = 1000;
        try {
            readVolume(file, {}, options);
            FAIL() << extension << " must respect the memory limit";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("needs"), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find("0.0 MB"), std::string::npos) << error.what();
        }
    }
}

TEST_F(VolumeFile, CloudInVdbEqualsItsDenseTwin) {
    const fs::path sparse = kShared / "data/volumes/wdas_cloud_sixteenth.vdb";
    const fs::path dense = kShared / "benchmark/wdas_cloud_sixteenth.vol";
    if (!fs::exists(sparse) || !fs::exists(dense)) GTEST_SKIP() << "needs " << sparse << " and " << dense;
    const Volume vdb = readVolume(sparse, {});
    const Volume vol = readVolume(dense, {});
    EXPECT_EQ(vdb.density.resolution(), glm::uvec3(126, 86, 154));
    EXPECT_EQ(vdb.density.toDense(), vol.density.toDense());
    EXPECT_EQ(vdb.note, "");
    // Scale 10/3 from the file's header; the active box from its metadata file_bbox_min, file_bbox_max.
    const double voxel = vdb.boundsMax.x - vdb.boundsMin.x;
    EXPECT_NEAR(vdb.boundsMin.x, voxel / 126 * (-66 - 0.5), 1e-9);
    EXPECT_NEAR(vdb.boundsMin.y, voxel / 126 * (-21 - 0.5), 1e-9);
    EXPECT_NEAR(vdb.boundsMax.z, voxel / 126 * (63 + 0.5), 1e-9);
}

TEST_F(VolumeFile, RealFilesSurviveEveryFormat) {
    for (const std::string name : {"wdas_cloud_sixteenth.vdb", "smoke.vol", "teapot_cloud.nvdb"}) {
        const fs::path file = kShared / "data/volumes" / name;
        if (!fs::exists(file)) GTEST_SKIP() << "needs " << file;
        SCOPED_TRACE(name);
        const Volume volume = readVolume(file, {});
        EXPECT_GT(volume.density.maximum(), 0.0f);
        for (const std::string& extension : kExtensions) {
            SCOPED_TRACE(extension);
            expectSameField(writeAndRead(volume, extension), volume);
        }
    }
}

TEST_F(VolumeFile, TeapotHasTheBoxOfItsMetadata) {
    const fs::path file = kShared / "data/volumes/teapot_cloud.nvdb";
    if (!fs::exists(file)) GTEST_SKIP() << "needs " << file;
    const Volume volume = readVolume(file, {});
    // Index box (-136, -60, -90) to (130, 73, 87), as the file's metadata states it.
    EXPECT_EQ(volume.density.resolution(), glm::uvec3(267, 134, 178));
    EXPECT_EQ(volume.channels, 1u);
}

}  // namespace
}  // namespace parhelion
