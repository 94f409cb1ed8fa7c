// Both codecs everywhere: IO.h instantiates one template differently by these macros.
#define NANOVDB_USE_BLOSC
#define NANOVDB_USE_ZIP

#include <fmt/format.h>
#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/IO.h>

#include "volume/vdb_leaves.h"
#include "volume/volume_formats.h"

namespace parhelion {

namespace {

nanovdb::GridHandle<> toNanoVdb(const Volume& volume) {
    nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::FogVolume);
    auto accessor = builder.getAccessor();
    for (const VdbLeaf& leaf : vdbLeaves(volume.density)) {
        auto value = leaf.values.begin();
        for (unsigned i = 0; i < kLeafVoxels; ++i) {
            if ((leaf.active[i / 64] >> (i % 64) & 1u) == 0) continue;
            const glm::ivec3 voxel = glm::ivec3(leaf.origin) + glm::ivec3(i / 64, i / 8 % 8, i % 8);
            accessor.setValue(nanovdb::Coord(voxel.x, voxel.y, voxel.z), *value++);
        }
    }
    const VdbPlacement placement = vdbPlacement(volume);
    const glm::dmat3 matrix(placement.voxelSize.x, 0, 0, 0, placement.voxelSize.y, 0, 0, 0, placement.voxelSize.z);
    nanovdb::Map map;
    map.set(matrix, glm::inverse(matrix), placement.firstCentre, 1.0);
    return builder.getHandle(map, "density");
}

}  // namespace

void writeNanoVdbVolume(const std::filesystem::path& file, const Volume& volume) {
    try {
        // The codec that other renderers' readers are built with.
        nanovdb::io::writeGrid(file.string(), toNanoVdb(volume), nanovdb::io::Codec::ZIP);
    } catch (const std::exception& error) {  // NanoVDB reports a full disk by exceptions of its own
        throw RuntimeFailure(fmt::format("cannot write '{}': {}", file.string(), error.what()));
    }
}

}  // namespace parhelion
