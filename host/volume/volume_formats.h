#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "base/error.h"
#include "volume/density_grid.h"
#include "volume/volume_file.h"

namespace parhelion {

/// What every reader gets: the whole file (16-byte aligned), the location that errors blame, and the user's options.
struct VolumeBytes {
    std::span<const std::byte> bytes;
    SourceLocation where;
    const VolumeReadOptions& options;
};

Volume readMitsubaVolume(const VolumeBytes& input);
Volume readGridVolume(const VolumeBytes& input);
Volume readOpenVdbVolume(const VolumeBytes& input);
Volume readNanoVdbVolume(const VolumeBytes& input);

void writeMitsubaVolume(const std::filesystem::path& file, const Volume& volume);
void writeGridVolume(const std::filesystem::path& file, const Volume& volume, GridValueType type);
/// Both need one channel.
void writeOpenVdbVolume(const std::filesystem::path& file, const Volume& volume);
void writeNanoVdbVolume(const std::filesystem::path& file, const Volume& volume);

/// Turns a whole dense field (x fastest, channels interleaved) into a volume: checks the values and the
/// memory they will take, drops empty bricks. Leaves the bounds to the caller.
Volume volumeFromDense(const VolumeBytes& input, glm::uvec3 resolution, unsigned channels,
                       std::span<const float> values);

/// The dense values of either kind of volume, x fastest, channels interleaved.
std::vector<float> denseValues(const Volume& volume);

inline glm::uvec3 resolutionOf(const Volume& volume) {
    return volume.channels == 1 ? volume.density.resolution() : volume.color.resolution;
}

}  // namespace parhelion
