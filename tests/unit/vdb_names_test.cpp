// Which grid of a .vdb or .nvdb file is read, by name.
#define NANOVDB_USE_BLOSC  // as in nvdb_write.cpp: one definition of the templates
#define NANOVDB_USE_ZIP

#include <gtest/gtest.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "support/temporary_folder.h"
#include "volume/volume_file.h"

namespace parhelion {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::FloatGrid;

class VdbNames : public testing::Test {
protected:
    void SetUp() override { openvdb::initialize(); }

    fs::path path(const std::string& name) const { return folder_.path() / name; }

    fs::path write(const openvdb::GridCPtrVec& grids) {
        openvdb::io::File file(path("grids.vdb").string());
        file.write(grids);
        file.close();
        return path("grids.vdb");
    }

    test::TemporaryFolder folder_;
};

/// One voxel of that value.
FloatGrid::Ptr named(const std::string& name, float value) {
    FloatGrid::Ptr grid = FloatGrid::create(0.0f);
    grid->tree().setValue(Coord(0), value);
    grid->setName(name);
    return grid;
}

openvdb::Int32Grid::Ptr integersNamed(const std::string& name) {
    openvdb::Int32Grid::Ptr grid = openvdb::Int32Grid::create();
    grid->tree().setValue(Coord(0), 9);
    grid->setName(name);
    return grid;
}

TEST_F(VdbNames, ChoosesDensityElseTheFirstFloatGridElseTheNamedOne) {
    const openvdb::Int32Grid::Ptr integers = integersNamed("ids");
    const openvdb::GridCPtrVec both{integers, named("heat", 1.0f), named("density", 2.0f), named("fuel", 3.0f)};
    EXPECT_EQ(readVolume(write(both), {}).density.maximum(), 2.0f);
    EXPECT_EQ(readVolume(write(both), {}, {"fuel"}).density.maximum(), 3.0f);
    EXPECT_EQ(readVolume(write({integers, named("heat", 1.0f), named("fuel", 3.0f)}), {}).density.maximum(), 1.0f);
    EXPECT_THROW(readVolume(write(both), {}, {"ids"}), InputError);
    EXPECT_THROW(readVolume(write(both), {}, {"smoke"}), InputError);
    EXPECT_THROW(readVolume(write({integers}), {}), InputError);
}

TEST_F(VdbNames, GridsOfOneNameAreNotedAndNumbered) {
    const openvdb::GridCPtrVec grids{named("heat", 1.0f), named("density", 2.0f), integersNamed("density"),
                                     named("density", 3.0f)};
    const fs::path file = write(grids);
    const Volume first = readVolume(file, {});
    EXPECT_EQ(first.density.maximum(), 2.0f);
    EXPECT_EQ(first.note,
              "of 2 grids \"density\" the first, \"density[0]\", was read; others can be named: \"density[2]\"");
    EXPECT_NE(first.source.find("density[0]"), std::string::npos) << first.source;
    EXPECT_EQ(readVolume(file, {}, {"density"}).note, first.note);
    for (const auto& [name, value] : std::map<std::string, float>{{"density[0]", 2.0f}, {"density[2]", 3.0f}}) {
        const Volume volume = readVolume(file, {}, {name});
        EXPECT_EQ(volume.density.maximum(), value) << name;
        EXPECT_EQ(volume.note, "") << "the name leaves no doubt";
        // The library means the same by it.
        openvdb::io::File library(file.string());
        library.open(false);
        const auto expected = openvdb::gridPtrCast<FloatGrid>(library.readGrid(name));
        EXPECT_EQ(expected->getConstAccessor().getValue(Coord(0)), value) << name;
    }
    EXPECT_EQ(readVolume(file, {}, {"heat"}).note, "");
    for (const char* name : {"density[1]", "density[3]", "density[]", "density[0", "heat[0]"})
        EXPECT_THROW(readVolume(file, {}, {name}), InputError) << name;
}

TEST_F(VdbNames, NanoVdbGridsOfOneNameAreNotedAndNumbered) {
    std::vector<nanovdb::GridHandle<nanovdb::HostBuffer>> grids;
    for (const float value : {2.0f, 3.0f, 4.0f}) grids.push_back(nanovdb::openToNanoVDB(*named("smoke", value)));
    nanovdb::io::writeGrids(path("smoke.nvdb").string(), grids);
    const Volume first = readVolume(path("smoke.nvdb"), {}, {"smoke"});
    EXPECT_EQ(first.density.maximum(), 2.0f);
    EXPECT_EQ(
        first.note,
        "of 3 grids \"smoke\" the first, \"smoke[0]\", was read; others can be named: \"smoke[1]\", \"smoke[2]\"");
    EXPECT_EQ(readVolume(path("smoke.nvdb"), {}, {"smoke[1]"}).density.maximum(), 3.0f);
    EXPECT_EQ(readVolume(path("smoke.nvdb"), {}, {"smoke[2]"}).density.maximum(), 4.0f);
    EXPECT_THROW(readVolume(path("smoke.nvdb"), {}, {"smoke[3]"}), InputError);
}

TEST_F(VdbNames, FirstOfSeveralNamesIsNotedUnlessItIsDensity) {
    const fs::path file = write({named("", 1.0f), named("heat", 2.0f), named("", 3.0f), integersNamed("ids")});
    const Volume first = readVolume(file, {});
    EXPECT_EQ(first.density.maximum(), 1.0f);
    EXPECT_EQ(first.note, "of 3 grids the first, \"[0]\", was read; others can be named: \"heat\", \"[1]\"");
    EXPECT_EQ(readVolume(file, {}, {"[1]"}).density.maximum(), 3.0f);
    EXPECT_EQ(readVolume(write({named("heat", 2.0f), named("density", 5.0f)}), {}).note, "");
    EXPECT_EQ(readVolume(write({named("heat", 2.0f), integersNamed("ids")}), {}).note, "");
    EXPECT_EQ(readVolume(write({named("a[1]", 2.0f), named("a", 3.0f), named("a", 4.0f)}), {}, {"a[1]"}).note, "")
        << "a grid of exactly that name comes first";
}

}  // namespace
}  // namespace parhelion
