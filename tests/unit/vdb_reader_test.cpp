// Our readers of .vdb and .nvdb files against the libraries that wrote them.
#define NANOVDB_USE_BLOSC  // as in nvdb_write.cpp: one definition of the templates
#define NANOVDB_USE_ZIP

#include <gtest/gtest.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "support/temporary_folder.h"
#include "volume/volume_file.h"

namespace parhelion {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::FloatGrid;

class VdbReader : public testing::Test {
protected:
    void SetUp() override { openvdb::initialize(); }

    fs::path path(const std::string& name) const { return folder_.path() / name; }

    fs::path write(const openvdb::GridCPtrVec& grids, std::uint32_t compression = openvdb::io::COMPRESS_ACTIVE_MASK) {
        openvdb::io::File file(path("grids.vdb").string());
        file.setCompression(compression);
        file.write(grids);
        file.close();
        return path("grids.vdb");
    }

    template <typename BuildT>
    fs::path writeNano(const FloatGrid& grid, nanovdb::io::Codec codec) {
        nanovdb::io::writeGrid(path("grid.nvdb").string(),
                               nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::FloatTree, BuildT>(grid), codec);
        return path("grid.nvdb");
    }

    test::TemporaryFolder folder_;
};

/// Leaves with few and with all voxels active, on both sides of zero and of several nodes, and tiles of two sizes.
FloatGrid::Ptr mixedGrid() {
    std::mt19937 random(11);
    FloatGrid::Ptr grid = FloatGrid::create(0.0f);
    auto accessor = grid->getAccessor();
    const auto value = [&] { return float(random() >> 8) * 0x1p-24f; };
    for (int i = 0; i < 400; ++i)
        accessor.setValue(Coord(int(random() % 300) - 150, int(random() % 40) - 20, int(random() % 60)), value());
    grid->denseFill(openvdb::CoordBBox(Coord(-9), Coord(20)), 0.75f);
    for (auto it = grid->beginValueOn(); it; ++it)
        if (it.isVoxelValue()) it.setValue(value());
    grid->tree().addTile(1, Coord(40, 8, 16), 0.5f, true);    // 8^3 voxels
    grid->tree().addTile(2, Coord(-256, 0, 0), 0.25f, true);  // 128^3 voxels
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return grid;
}

/// Compares every voxel of the box with the library's own lookup.
void expectEqualsLibrary(const Volume& volume, const FloatGrid& grid, float tolerance = 0) {
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    const glm::uvec3 size(box.dim().x(), box.dim().y(), box.dim().z());
    ASSERT_EQ(volume.density.resolution(), size);
    const std::vector<float> values = volume.density.toDense();
    const auto accessor = grid.getConstAccessor();
    std::size_t index = 0;
    for (int z = box.min().z(); z <= box.max().z(); ++z)
        for (int y = box.min().y(); y <= box.max().y(); ++y)
            for (int x = box.min().x(); x <= box.max().x(); ++x) {
                const Coord voxel(x, y, z);
                const float expected = accessor.isValueOn(voxel) ? accessor.getValue(voxel) : 0.0f;
                ASSERT_NEAR(values[index++], expected, tolerance) << voxel;
            }
}

TEST_F(VdbReader, ReadsEveryCompressionAsTheLibrary) {
    using namespace openvdb::io;
    for (const bool half : {false, true}) {
        FloatGrid::Ptr grid = mixedGrid();
        grid->setSaveFloatAsHalf(half);
        for (std::uint32_t compression = 0; compression < 8; ++compression) {
            if ((compression & COMPRESS_ZIP) && (compression & COMPRESS_BLOSC)) continue;
            SCOPED_TRACE(compressionToString(compression) + (half ? " half" : ""));
            const fs::path file = write({grid}, compression);
            File library(file.string());
            library.open(false);
            // The library's reading, so that rounding to half floats is in both.
            const auto expected = openvdb::gridPtrCast<FloatGrid>(library.readGrid("density"));
            expectEqualsLibrary(readVolume(file, {}), *expected);
        }
    }
}

TEST_F(VdbReader, BoxOfNegativeIndicesLiesWhereTheTransformPutsIt) {
    FloatGrid::Ptr grid = FloatGrid::create(0.0f);
    grid->tree().setValue(Coord(-5, -7, -9), 1.0f);
    grid->tree().setValue(Coord(-2, 3, -9), 2.0f);
    grid->setTransform(std::make_shared<openvdb::math::Transform>(std::make_shared<openvdb::math::ScaleTranslateMap>(
        openvdb::Vec3d(0.5, 1.0, 2.0), openvdb::Vec3d(10.0, 20.0, 30.0))));
    nanovdb::io::writeGrid(path("box.nvdb").string(), nanovdb::openToNanoVDB(*grid));
    for (const fs::path& file : {write({grid}), path("box.nvdb")}) {
        const Volume volume = readVolume(file, {});
        EXPECT_EQ(volume.density.resolution(), glm::uvec3(4, 11, 1));
        EXPECT_EQ(volume.density.at({0, 0, 0}), 1.0f);
        EXPECT_EQ(volume.density.at({3, 10, 0}), 2.0f);
        // Voxel i is centred at index i: the box reaches half a voxel further. All numbers are exact in binary.
        EXPECT_EQ(volume.boundsMin, glm::dvec3(10 - 5.5 * 0.5, 20 - 7.5, 30 - 9.5 * 2));
        EXPECT_EQ(volume.boundsMax, glm::dvec3(10 - 1.5 * 0.5, 20 + 3.5, 30 - 8.5 * 2));
    }
}

TEST_F(VdbReader, EveryAlignedTransformTypeIsRead) {
    using namespace openvdb::math;
    FloatGrid::Ptr grid = FloatGrid::create(0.0f);
    grid->tree().setValue(Coord(0), 1.0f);
    const openvdb::Vec3d shift(1, 2, 3);
    openvdb::Mat4d affine = openvdb::Mat4d::identity();
    affine.preScale(openvdb::Vec3d(2.0));
    affine.postTranslate(shift);
    const std::vector<std::pair<MapBase::Ptr, glm::dvec3>> maps{
        {std::make_shared<UniformScaleMap>(2.0), {-1, -1, -1}},
        {std::make_shared<ScaleMap>(openvdb::Vec3d(2, 4, 6)), {-1, -2, -3}},
        {std::make_shared<TranslationMap>(shift), {0.5, 1.5, 2.5}},
        {std::make_shared<UniformScaleTranslateMap>(2.0, shift), {0, 1, 2}},
        {std::make_shared<ScaleTranslateMap>(openvdb::Vec3d(2, 4, 6), shift), {0, 0, 0}},
        {std::make_shared<AffineMap>(affine), {0, 1, 2}},
    };
    for (const auto& [map, boundsMin] : maps) {
        grid->setTransform(std::make_shared<Transform>(map));
        EXPECT_EQ(readVolume(write({grid}), {}).boundsMin, boundsMin) << map->type();
    }
}

TEST_F(VdbReader, RotatedShearedMirroredAndFrustumTransformsAreRefused) {
    using namespace openvdb::math;
    FloatGrid::Ptr grid = FloatGrid::create(0.0f);
    grid->tree().setValue(Coord(0), 1.0f);
    openvdb::Mat4d rotation = openvdb::Mat4d::identity(), shear = rotation;
    rotation.preRotate(Y_AXIS, 0.3);
    shear.preShear(X_AXIS, Z_AXIS, 0.1);
    const openvdb::BBoxd box(openvdb::Vec3d(0), openvdb::Vec3d(10));
    for (const MapBase::Ptr& map :
         std::vector<MapBase::Ptr>{std::make_shared<AffineMap>(rotation), std::make_shared<AffineMap>(shear),
                                   std::make_shared<ScaleMap>(openvdb::Vec3d(1, -1, 1)),
                                   std::make_shared<NonlinearFrustumMap>(box, 0.5, 1.0)}) {
        grid->setTransform(std::make_shared<Transform>(map));
        EXPECT_THROW(readVolume(write({grid}), {}), InputError) << map->type();
    }
}

TEST_F(VdbReader, BackgroundAndInactiveValuesBecomeZeroWithANote) {
    FloatGrid::Ptr grid = FloatGrid::create(3.0f);
    grid->tree().setValue(Coord(0), 1.0f);
    grid->tree().setValue(Coord(2, 0, 0), 1.0f);
    grid->tree().setValueOff(Coord(1, 0, 0), 7.0f);
    nanovdb::io::writeGrid(path("background.nvdb").string(), nanovdb::openToNanoVDB(*grid));
    for (const fs::path& file : {write({grid}), path("background.nvdb")}) {
        const Volume volume = readVolume(file, {});
        EXPECT_EQ(volume.density.toDense(), (std::vector<float>{1.0f, 0.0f, 1.0f}));
        EXPECT_NE(volume.note.find("background value 3"), std::string::npos) << volume.note;
        EXPECT_NE(volume.note.find("1 inactive"), std::string::npos) << volume.note;
    }
}

TEST_F(VdbReader, EmptyGridsAndHugeBoxesAreRefused) {
    FloatGrid::Ptr grid = FloatGrid::create(0.0f);
    EXPECT_THROW(readVolume(write({grid}), {}), InputError);
    grid->tree().setValue(Coord(0), 1.0f);
    grid->tree().setValue(Coord(8192, 0, 0), 1.0f);
    EXPECT_THROW(readVolume(write({grid}), {}), InputError);
    // One tile of 4096^3 voxels in a few bytes: 2.7e11 bytes of bricks.
    grid = FloatGrid::create(0.0f);
    grid->tree().addTile(3, Coord(0), 1.0f, true);
    VolumeReadOptions options;
    options.memoryLimitBytes = std::size_t(1) << 32;
    EXPECT_THROW(readVolume(write({grid}), {}, options), InputError);
}

TEST_F(VdbReader, NanoVdbCodecsReadAsTheLibrary) {
    const FloatGrid::Ptr grid = mixedGrid();
    for (const auto codec : {nanovdb::io::Codec::NONE, nanovdb::io::Codec::ZIP, nanovdb::io::Codec::BLOSC}) {
        SCOPED_TRACE(nanovdb::io::toStr(codec));
        expectEqualsLibrary(readVolume(writeNano<float>(*grid, codec), {}), *grid);
    }
}

TEST_F(VdbReader, NanoVdbQuantisedGridsReadWithinTheirStep) {
    const FloatGrid::Ptr grid = mixedGrid();
    const auto codec = nanovdb::io::Codec::NONE;
    // Values span at most [0, 1] in a leaf: dithering moves a value by up to one quantum of its leaf.
    expectEqualsLibrary(readVolume(writeNano<nanovdb::Fp4>(*grid, codec), {}), *grid, 1.0f / 15);
    expectEqualsLibrary(readVolume(writeNano<nanovdb::Fp8>(*grid, codec), {}), *grid, 1.0f / 255);
    expectEqualsLibrary(readVolume(writeNano<nanovdb::Fp16>(*grid, codec), {}), *grid, 1.0f / 65535);
    // The writer picks each leaf's bits for an absolute error of 0.01 (its default for fog volumes).
    expectEqualsLibrary(readVolume(writeNano<nanovdb::FpN>(*grid, codec), {}), *grid, 0.01f);
}

TEST_F(VdbReader, NegativeAndNonFiniteVoxelsAreNamed) {
    for (const float bad : {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        FloatGrid::Ptr grid = FloatGrid::create(0.0f);
        grid->tree().setValue(Coord(-3, 4, 5), bad);
        nanovdb::io::writeGrid(path("bad.nvdb").string(), nanovdb::openToNanoVDB(*grid));
        for (const fs::path& file : {write({grid}), path("bad.nvdb")}) {
            try {
                readVolume(file, {});
                FAIL() << bad << " must be refused in " << file;
            } catch (const InputError& error) {
                EXPECT_NE(std::string(error.what()).find("(-3, 4, 5)"), std::string::npos) << error.what();
            }
        }
    }
}

/// Changes bytes that are not zero (masks, offsets, lengths: most of a file is zeros) one to four at a time.
void expectDamageDoesNotCrash(const fs::path& file) {
    std::stringstream content;
    content << std::ifstream(file, std::ios::binary).rdbuf();
    const std::string bytes = content.str();
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < bytes.size(); ++i)
        if (bytes[i] != 0) used.push_back(i);
    VolumeReadOptions options;
    options.memoryLimitBytes = std::size_t(1) << 26;
    std::mt19937 random(23);
    int refused = 0;
    for (int trial = 0; trial < 300; ++trial) {
        std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
        std::vector<std::size_t> changed;
        for (unsigned i = 0; i <= trial % 4u; ++i) {
            changed.push_back(used[random() % (trial % 2 ? used.size() : used.size() / 8)]);
            stream.seekp(static_cast<std::streamoff>(changed.back()));
            stream.put(static_cast<char>(random()));
        }
        stream.flush();
        try {
            readVolume(file, {}, options);
        } catch (const InputError&) {
            ++refused;
        }
        for (const std::size_t position : changed) {
            stream.seekp(static_cast<std::streamoff>(position));
            stream.put(bytes[position]);
        }
    }
    EXPECT_GT(refused, 0) << "no damage was noticed: the test changes nothing that matters";
    EXPECT_NO_THROW(readVolume(file, {}, options)) << "the bytes must be restored";
}

TEST_F(VdbReader, DamageInsideUncompressedTreesDoesNotCrash) {
    FloatGrid::Ptr grid = FloatGrid::create(0.0f);
    for (int i = 0; i < 200; ++i) grid->tree().setValue(Coord(7 * i % 90 - 40, 11 * i % 50, i % 37), 1.0f + float(i));
    grid->tree().addTile(1, Coord(-96, 0, 0), 0.5f, true);
    using nanovdb::ChecksumMode, nanovdb::StatsMode;
    // Without a checksum, so that damage reaches the nodes.
    const auto plain = nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::FloatTree, float>(*grid, StatsMode::Default,
                                                                                              ChecksumMode::Disable);
    const auto packed = nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::FloatTree, nanovdb::FpN>(
        *grid, StatsMode::Default, ChecksumMode::Disable);
    nanovdb::io::writeGrid(path("plain.nvdb").string(), plain);
    nanovdb::io::writeGrid(path("packed.nvdb").string(), packed);
    expectDamageDoesNotCrash(path("plain.nvdb"));
    expectDamageDoesNotCrash(path("packed.nvdb"));
    for (const std::uint32_t compression : {0, 1, 2, 3, 6}) expectDamageDoesNotCrash(write({grid}, compression));
}

}  // namespace
}  // namespace parhelion
