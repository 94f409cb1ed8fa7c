#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "volume/density_grid.h"
#include "volume/volume_file.h"

namespace parhelion {

/// Where the outermost values of a .grid lie relative to its bounds.
enum class GridLattice : std::uint8_t {
    kCell,  ///< half a voxel inside the bounds, as in DensityGrid
    kNode,  ///< on the bounds
};

enum class GridLayout : std::uint8_t {
    kDense,   ///< every voxel, x fastest, channels interleaved
    kSparse,  ///< one bit per brick of 8^3, then the 512 values of each brick whose bit is set
};

/// The header of a .grid file, byte for byte (little endian); scenes/README.md describes it.
struct GridHeader {
    char magic[8];  ///< "PARHGRID"
    std::uint32_t version;
    std::uint32_t resolution[3];
    double boundsMin[3];
    double boundsMax[3];
    GridLattice lattice;
    GridValueType valueType;
    std::uint8_t channels;
    GridLayout layout;
    float scale;               ///< value = scale * stored, stored in [0, 1] for kUnorm8; 1 for the float types
    std::uint64_t brickCount;  ///< bricks stored; 0 when dense
    std::uint64_t payloadBytes;
    std::uint32_t checksum;  ///< gridChecksum()
    std::uint32_t reserved;  ///< 0
};
static_assert(sizeof(GridHeader) == 104 && offsetof(GridHeader, boundsMin) == 24 &&
              offsetof(GridHeader, lattice) == 72 && offsetof(GridHeader, checksum) == 96);

constexpr char kGridMagic[] = "PARHGRID";
constexpr std::uint32_t kGridVersion = 1;

/// CRC-32 (that of zlib and PNG) of the header up to the checksum, followed by the payload.
std::uint32_t gridChecksum(const GridHeader& header, std::span<const std::byte> payload);

/// Bytes of a value in the file.
constexpr std::uint64_t bytesPerValue(GridValueType type) {
    return type == GridValueType::kFloat32 ? 4 : type == GridValueType::kFloat16 ? 2 : 1;
}

/// Bytes of the occupancy bits of a sparse grid.
constexpr std::uint64_t occupancyBytes(std::uint64_t bricks) { return (bricks + 7) / 8; }

}  // namespace parhelion
