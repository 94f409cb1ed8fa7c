#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/error.h"
#include "volume/density_grid.h"

namespace parhelion {

/// How to read a volume file.
struct VolumeReadOptions {
    std::string gridName;             ///< .vdb, .nvdb: grid to read; empty: "density", else the first float grid
    std::size_t memoryLimitBytes = 0; ///< refuse larger grids before allocating; 0: half of the machine's memory
};

/// Reads .vol (Mitsuba 3), .grid (ours), .vdb (OpenVDB) or .nvdb (NanoVDB), told apart by content.
///
/// @param where  blamed for a missing file (the scene's location of the name); the file itself is blamed for damage.
/// @throws InputError for a missing, truncated, damaged or too large file, and for values that are
///         negative or not finite (naming the first voxel).
Volume readVolume(const std::filesystem::path& file, const SourceLocation& where, const VolumeReadOptions& options = {});

/// Writes .vol, .grid, .vdb or .nvdb by the extension, through a temporary file and a rename.
/// @throws InputError for an unknown extension.
void writeVolume(const std::filesystem::path& file, const Volume& volume);

}  // namespace parhelion
