#include <Imath/half.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "volume/byte_reader.h"
#include "volume/grid_format.h"
#include "volume/volume_checks.h"
#include "volume/volume_formats.h"

namespace parhelion {

namespace {

glm::uvec3 resolutionOf(const GridHeader& header) {
    return {header.resolution[0], header.resolution[1], header.resolution[2]};
}

glm::uvec3 brickCountsOf(const GridHeader& header) {
    return (resolutionOf(header) + (DensityGrid::kBrickSize - 1)) / DensityGrid::kBrickSize;
}

std::uint64_t product(glm::u64vec3 v) { return v.x * v.y * v.z; }

void checkEnumerations(const ByteReader& reader, const GridHeader& header) {
    if (header.lattice > GridLattice::kNode)
        reader.fail(fmt::format("lattice must be 0 (cell) or 1 (node); got {}", int(header.lattice)));
    if (header.valueType > GridValueType::kUnorm8)
        reader.fail(
            fmt::format("value type must be 0 (float32), 1 (float16) or 2 (8 bit); got {}", int(header.valueType)));
    if (header.channels != 1 && header.channels != 3)
        reader.fail(fmt::format("channels must be 1 or 3; got {}", header.channels));
    if (header.layout > GridLayout::kSparse)
        reader.fail(fmt::format("layout must be 0 (dense) or 1 (sparse); got {}", int(header.layout)));
    if (header.layout == GridLayout::kSparse && header.channels != 1)
        reader.fail("a sparse grid must have one channel; got 3");
    if (header.reserved != 0) reader.fail(fmt::format("reserved field must be 0; got {}", header.reserved));
}

void checkScale(const ByteReader& reader, const GridHeader& header) {
    const bool allowed = header.valueType == GridValueType::kUnorm8
                             ? header.scale >= 0 && header.scale <= std::numeric_limits<float>::max()
                             : header.scale == 1.0f;
    if (!allowed)
        reader.fail(
            fmt::format("scale must be 1 for float values, finite and >= 0 for 8-bit ones; got {}", header.scale));
}

/// Compares the sizes that the header states with those that follow from it. The resolution is already checked,
/// so no product overflows.
void checkSizes(const ByteReader& reader, const GridHeader& header) {
    const std::uint64_t bricks = product(brickCountsOf(header));
    const bool sparse = header.layout == GridLayout::kSparse;
    if (header.brickCount > (sparse ? bricks : 0))
        reader.fail(fmt::format("brick count must be at most {}; got {}", sparse ? bricks : 0, header.brickCount));
    const std::uint64_t values =
        sparse ? header.brickCount * DensityGrid::kBrickVoxels : product(resolutionOf(header)) * header.channels;
    const std::uint64_t expected = values * bytesPerValue(header.valueType) + (sparse ? occupancyBytes(bricks) : 0);
    if (header.payloadBytes != expected)
        reader.fail(
            fmt::format("payload must have {} bytes for this resolution; got {}", expected, header.payloadBytes));
    if (reader.remaining() != header.payloadBytes)
        reader.fail(fmt::format("truncated or damaged: {} bytes must follow the header; got {}", header.payloadBytes,
                                reader.remaining()));
}

GridHeader readHeader(ByteReader& reader) {
    const auto header = reader.read<GridHeader>("the header");
    if (header.version != kGridVersion)
        reader.fail(fmt::format(".grid version must be {}; got {}", kGridVersion, header.version));
    checkResolution(reader.where(), resolutionOf(header));
    checkBounds(reader.where(), {header.boundsMin[0], header.boundsMin[1], header.boundsMin[2]},
                {header.boundsMax[0], header.boundsMax[1], header.boundsMax[2]});
    checkEnumerations(reader, header);
    checkScale(reader, header);
    checkSizes(reader, header);
    return header;
}

/// The stored values as floats; `storage` holds them when they are not floats already.
std::span<const float> decodeValues(std::span<const std::byte> bytes, const GridHeader& header,
                                    std::vector<float>& storage) {
    const std::size_t count = bytes.size() / bytesPerValue(header.valueType);
    storage.resize(count);
    switch (header.valueType) {
        case GridValueType::kFloat32:
            std::memcpy(storage.data(), bytes.data(), bytes.size());
            break;
        case GridValueType::kFloat16:
            for (std::size_t i = 0; i < count; ++i) {
                std::uint16_t bits;
                std::memcpy(&bits, &bytes[2 * i], sizeof(bits));
                storage[i] = imath_half_to_float(bits);
            }
            break;
        case GridValueType::kUnorm8:
            for (std::size_t i = 0; i < count; ++i) storage[i] = header.scale * (static_cast<float>(bytes[i]) / 255.0f);
            break;
    }
    return storage;
}

void checkBrick(const SourceLocation& where, std::span<const float> values, glm::uvec3 first, glm::uvec3 resolution) {
    for (unsigned i = 0; i < DensityGrid::kBrickVoxels; ++i) {
        const glm::uvec3 voxel = first + glm::uvec3(i % 8, i / 8 % 8, i / 64);
        checkValue(where, values[i], voxel);
        if (values[i] != 0.0f && glm::any(glm::greaterThanEqual(voxel, resolution)))
            throw InputError(where, fmt::format("voxel ({}, {}, {}) lies beyond the resolution and must be 0; got {}",
                                                voxel.x, voxel.y, voxel.z, values[i]));
    }
}

DensityGrid readBricks(ByteReader& reader, const GridHeader& header) {
    const glm::uvec3 resolution = resolutionOf(header);
    const std::uint64_t bricks = product(brickCountsOf(header));
    const std::span<const std::byte> occupancy = reader.take(occupancyBytes(bricks), "the brick occupancy");
    std::uint64_t occupied = 0;
    for (const std::byte bits : occupancy) occupied += std::popcount(static_cast<std::uint8_t>(bits));
    if (occupied != header.brickCount)
        reader.fail(fmt::format("{} bricks must be marked occupied; got {}", header.brickCount, occupied));

    DensityGrid grid(resolution);
    grid.reserveBricks(header.brickCount);
    std::vector<float> storage;
    for (std::uint64_t index = 0; index < occupancy.size() * 8; ++index) {
        if ((static_cast<unsigned>(occupancy[index / 8]) >> (index % 8) & 1u) == 0) continue;
        if (index >= bricks) reader.fail("the unused bits of the brick occupancy must be 0");
        const glm::uvec3 brick = grid.brickAt(index);
        const auto bytes = reader.take(DensityGrid::kBrickVoxels * bytesPerValue(header.valueType), "a brick");
        const std::span<const float> values = decodeValues(bytes, header, storage);
        checkBrick(reader.where(), values, brick * DensityGrid::kBrickSize, resolution);
        std::ranges::copy(values, grid.allocateBrick(brick).begin());
    }
    return grid;
}

/// Sets the bounds of the voxel boxes: those of a node lattice reach half a voxel further.
void setBounds(Volume& volume, const GridHeader& header, const SourceLocation& where) {
    for (int axis = 0; axis < 3; ++axis) {
        const double low = header.boundsMin[axis], high = header.boundsMax[axis];
        double margin = 0;
        if (header.lattice == GridLattice::kNode) {
            if (header.resolution[axis] < 2)
                throw InputError(where, "a node lattice must have at least 2 values per axis; got 1");
            margin = 0.5 * (high - low) / (header.resolution[axis] - 1);
        }
        volume.boundsMin[axis] = low - margin;
        volume.boundsMax[axis] = high + margin;
    }
}

}  // namespace

std::uint32_t gridChecksum(const GridHeader& header, std::span<const std::byte> payload) {
    const uLong head = crc32_z(0, reinterpret_cast<const Bytef*>(&header), offsetof(GridHeader, checksum));
    return static_cast<std::uint32_t>(crc32_z(head, reinterpret_cast<const Bytef*>(payload.data()), payload.size()));
}

Volume readGridVolume(const VolumeBytes& input) {
    ByteReader reader(input.bytes, input.where);
    const GridHeader header = readHeader(reader);
    const auto payload = input.bytes.subspan(sizeof(GridHeader));
    if (const std::uint32_t actual = gridChecksum(header, payload); actual != header.checksum)
        reader.fail(fmt::format("damaged: the checksum must be {:08x}; got {:08x}", header.checksum, actual));

    Volume volume;
    if (header.layout == GridLayout::kSparse) {
        checkMemory(input.where, gridBytes(resolutionOf(header), header.brickCount), input.options.memoryLimitBytes);
        volume.density = readBricks(reader, header);
    } else {
        std::vector<float> storage;
        volume = volumeFromDense(input, resolutionOf(header), header.channels, decodeValues(payload, header, storage));
    }
    setBounds(volume, header, input.where);
    return volume;
}

}  // namespace parhelion
