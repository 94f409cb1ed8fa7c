#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "volume/density_grid.h"

namespace parhelion {

/// How to read a volume file.
struct VolumeReadOptions {
    /// .vdb, .nvdb: grid to read, "name" or, of several with one name, "name[1]"; empty: "density", else the first
    /// float grid. Volume::note names the others that fit.
    std::string gridName;
    SourceLocation gridNameWhere;      ///< blamed for a gridName that the format has no use for
    std::size_t memoryLimitBytes = 0;  ///< refuse larger grids before allocating; 0: half of the machine's memory
};

/// Reads .vol (Mitsuba 3), .grid (ours), .vdb (OpenVDB) or .nvdb (NanoVDB), told apart by content.
///
/// .vdb, .nvdb: the box of the active voxels, bounds in the file's world units; inactive voxels become 0
/// (Volume::note tells when they were not). The memory limit is about the grid; the file's bytes
/// and the values decoded from a dense .grid or an .nvdb come on top while it is read.
///
/// @param where  blamed for a missing file (the scene's location of the name); the file itself is blamed for damage.
/// @throws InputError for a missing, truncated, damaged or too large file, for a gridName where the file holds one
///         nameless grid, and for values that are negative or not finite (naming the first voxel).
Volume readVolume(const std::filesystem::path& file, const SourceLocation& where,
                  const VolumeReadOptions& options = {});

/// How a .grid file stores its values; the other formats always hold float32.
enum class GridValueType : std::uint8_t {
    kFloat32,  ///< exact
    kFloat16,  ///< relative error <= 2^-11, values <= 65504
    kUnorm8,   ///< absolute error <= maximum / 510
};

/// How to write a volume file.
struct VolumeWriteOptions {
    GridValueType valueType = GridValueType::kFloat32;  ///< .grid only
};

/// Writes .vol, .grid, .vdb or .nvdb by the extension, through a temporary file and a rename.
/// .vdb, .nvdb and .grid keep the sparsity; .vol is dense. Three-channel volumes go to .vol and .grid only.
/// @throws InputError for an unknown extension, a place that cannot be written, and a volume or option
///         that the format cannot hold.
/// @throws RuntimeFailure when writing fails half way (a full disk); the old file is then still in place.
void writeVolume(const std::filesystem::path& file, const Volume& volume, const VolumeWriteOptions& options = {});

}  // namespace parhelion
