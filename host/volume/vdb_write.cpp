// Both codecs everywhere: IO.h instantiates one template differently by these macros.
#define NANOVDB_USE_BLOSC
#define NANOVDB_USE_ZIP

#include <fmt/format.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include "volume/sparse_volume.h"
#include "volume/volume_formats.h"

namespace parhelion {

namespace {

/// A fog volume whose voxel (i, j, k) has index (i, j, k). Non-zero voxels are active.
openvdb::FloatGrid::Ptr toOpenVdb(const Volume& volume) {
    openvdb::initialize();  // registers types; repeated calls do nothing
    const DensityGrid& density = volume.density;
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
    for (std::size_t index = 0; index < density.brickTable().size(); ++index) {
        const glm::uvec3 brick = density.brickAt(index);
        const std::span<const float> values = density.brick(brick);
        if (values.empty()) continue;
        const glm::ivec3 first(brick * DensityGrid::kBrickSize);
        auto* leaf = grid->tree().touchLeaf(openvdb::Coord(first.x, first.y, first.z));
        for (unsigned i = 0; i < kLeafVoxels; ++i) {
            const unsigned transposed = (i % 8) * 64 + (i / 8 % 8) * 8 + i / 64;  // leaves have z fastest
            if (values[i] != 0.0f) leaf->setValueOn(transposed, values[i]);
        }
    }
    // Active zeros in two corners: the box of active voxels is what states the resolution.
    const glm::ivec3 last(density.resolution() - 1u);
    for (const openvdb::Coord corner : {openvdb::Coord(0), openvdb::Coord(last.x, last.y, last.z)})
        grid->tree().touchLeaf(corner)->setActiveState(corner, true);

    const glm::dvec3 size = (volume.boundsMax - volume.boundsMin) / glm::dvec3(density.resolution());
    const glm::dvec3 centre = volume.boundsMin + 0.5 * size;
    const auto map = std::make_shared<openvdb::math::ScaleTranslateMap>(openvdb::Vec3d(size.x, size.y, size.z),
                                                                        openvdb::Vec3d(centre.x, centre.y, centre.z));
    grid->setTransform(std::make_shared<openvdb::math::Transform>(map));
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return grid;
}

/// OpenVDB and NanoVDB report a full disk, like everything else, by exceptions of their own.
template <typename Write>
void translateErrors(const std::filesystem::path& file, const Write& write) {
    try {
        write();
    } catch (const std::exception& error) {
        throw RuntimeFailure(fmt::format("cannot write '{}': {}", file.string(), error.what()));
    }
}

}  // namespace

void writeOpenVdbVolume(const std::filesystem::path& file, const Volume& volume) {
    translateErrors(file, [&] {
        openvdb::io::File output(file.string());
        output.write(openvdb::GridCPtrVec{toOpenVdb(volume)});
        output.close();
    });
}

void writeNanoVdbVolume(const std::filesystem::path& file, const Volume& volume) {
    translateErrors(file, [&] {
        const auto handle = nanovdb::openToNanoVDB(*toOpenVdb(volume));
        // The codec that other renderers' readers are built with.
        nanovdb::io::writeGrid(file.string(), handle, nanovdb::io::Codec::ZIP);
    });
}

}  // namespace parhelion
