// Our .vdb and .nvdb files, read by the libraries that define them.
#define NANOVDB_USE_BLOSC  // as in nvdb_write.cpp: one definition of the templates
#define NANOVDB_USE_ZIP

#include <gtest/gtest.h>
#include <nanovdb/util/IO.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <random>

#include "support/temporary_folder.h"
#include "volume/volume_file.h"

namespace parhelion {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;

class VdbWriter : public testing::Test {
protected:
    FloatGrid::Ptr writeAndRead(const Volume& volume) {
        openvdb::initialize();
        const std::string name = (folder_.path() / "written.vdb").string();
        writeVolume(name, volume, {});
        openvdb::io::File file(name);
        file.open(false);
        EXPECT_EQ(file.getGrids()->size(), 1u);
        return openvdb::gridPtrCast<FloatGrid>(file.readGrid("density"));
    }

    test::TemporaryFolder folder_;
};

/// Noise in some bricks, ramps that compress in others, one voxel far from all.
Volume unevenVolume(glm::uvec3 resolution) {
    std::mt19937 random(5);
    Volume volume;
    volume.density = DensityGrid(resolution);
    for (unsigned i = 0; i < 3000; ++i) {
        const glm::uvec3 p(random() % resolution.x, random() % resolution.y, random() % resolution.z);
        volume.density.set(p, i % 2 ? std::ldexp(float(random() >> 8), -20) : 0.25f);
    }
    volume.density.set(resolution / 2u, 0x1p-149f);
    volume.boundsMin = {-1.0, 2.0, 3.0};
    volume.boundsMax = volume.boundsMin + glm::dvec3(resolution) * glm::dvec3(0.5, 2.0, 0.125);
    return volume;
}

std::size_t countNonZero(const DensityGrid& density) {
    const auto values = density.voxels();
    return values.size() - std::size_t(std::ranges::count(values, 0.0f));
}

TEST_F(VdbWriter, OpenVdbReadsEveryVoxelAndNothingElse) {
    // Within one leaf; borders inside bricks; several lower nodes; two upper ones along y and z.
    for (const glm::uvec3 resolution :
         {glm::uvec3(1), glm::uvec3(5, 17, 9), glm::uvec3(300, 140, 64), glm::uvec3(9, 4100, 4099)}) {
        SCOPED_TRACE(resolution.y);
        const Volume volume = unevenVolume(resolution);
        const FloatGrid::Ptr grid = writeAndRead(volume);
        ASSERT_TRUE(grid);
        const glm::ivec3 last(resolution - 1u);
        EXPECT_EQ(grid->evalActiveVoxelBoundingBox(), openvdb::CoordBBox(Coord(0), Coord(last.x, last.y, last.z)));
        EXPECT_EQ(grid->background(), 0.0f);
        std::size_t nonZero = 0;
        for (auto voxel = grid->cbeginValueOn(); voxel; ++voxel) {
            const Coord at = voxel.getCoord();
            ASSERT_TRUE(voxel.isVoxelValue());
            ASSERT_EQ(*voxel, volume.density.at({at.x(), at.y(), at.z()})) << at;
            if (*voxel != 0.0f) ++nonZero;
        }
        EXPECT_EQ(nonZero, countNonZero(volume.density));
        // Half a voxel inside the bounds; all numbers are exact in binary.
        EXPECT_EQ(grid->indexToWorld(Coord(0)), openvdb::Vec3d(-0.75, 3.0, 3.0625));
        EXPECT_EQ(grid->voxelSize(), openvdb::Vec3d(0.5, 2.0, 0.125));
    }
}

TEST_F(VdbWriter, OpenVdbFindsWhatDescribesTheGrid) {
    const Volume volume = unevenVolume({40, 30, 20});
    const FloatGrid::Ptr grid = writeAndRead(volume);
    EXPECT_EQ(grid->getName(), "density");
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_FALSE(grid->saveFloatAsHalf());
    EXPECT_EQ(grid->metaValue<std::int64_t>("file_voxel_count"), std::int64_t(grid->activeVoxelCount()));
    EXPECT_EQ(grid->metaValue<openvdb::Vec3i>("file_bbox_max"), openvdb::Vec3i(39, 29, 19));
    // The map's derived members are in the file too.
    const auto map = grid->transform().map<openvdb::math::ScaleTranslateMap>();
    ASSERT_TRUE(map);
    const openvdb::math::ScaleTranslateMap exact(openvdb::Vec3d(0.5, 2.0, 0.125), openvdb::Vec3d(-0.75, 3.0, 3.0625));
    EXPECT_EQ(*map, exact);
    EXPECT_EQ(map->getInvScaleSqr(), exact.getInvScaleSqr());
    EXPECT_EQ(map->getInvTwiceScale(), exact.getInvTwiceScale());
    EXPECT_EQ(map->voxelSize(), exact.voxelSize());
    EXPECT_EQ(map->applyInverseMap(openvdb::Vec3d(1, 1, 1)), exact.applyInverseMap(openvdb::Vec3d(1, 1, 1)));
}

TEST_F(VdbWriter, NanoVdbReadsEveryVoxelAndItsPlace) {
    const Volume volume = unevenVolume({140, 35, 50});
    const std::string name = (folder_.path() / "written.nvdb").string();
    writeVolume(name, volume, {});
    const auto handle = nanovdb::io::readGrid(name);
    const nanovdb::FloatGrid* grid = handle.grid<float>();
    ASSERT_TRUE(grid);
    EXPECT_TRUE(grid->isFogVolume());
    EXPECT_STREQ(grid->gridName(), "density");
    EXPECT_EQ(grid->indexBBox(), nanovdb::CoordBBox(nanovdb::Coord(0), nanovdb::Coord(139, 34, 49)));
    EXPECT_EQ(grid->indexToWorld(nanovdb::Vec3d(0)), nanovdb::Vec3d(-0.75, 3.0, 3.0625));
    EXPECT_EQ(grid->voxelSize(), nanovdb::Vec3d(0.5, 2.0, 0.125));
    const auto accessor = grid->getAccessor();
    for (unsigned z = 0; z < 50; ++z)
        for (unsigned y = 0; y < 35; ++y)
            for (unsigned x = 0; x < 140; ++x)
                ASSERT_EQ(accessor.getValue(nanovdb::Coord(x, y, z)), volume.density.at({x, y, z}));
}

}  // namespace
}  // namespace parhelion
