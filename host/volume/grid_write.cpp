#include <Imath/half.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "volume/byte_writer.h"
#include "volume/grid_format.h"
#include "volume/volume_formats.h"

namespace parhelion {

namespace {

constexpr float kLargestHalf = 65504.0f;

void appendValues(std::vector<std::byte>& payload, std::span<const float> values, const GridHeader& header) {
    const std::size_t start = payload.size();
    payload.resize(start + values.size() * bytesPerValue(header.valueType));
    std::byte* target = payload.data() + start;
    switch (header.valueType) {
        case GridValueType::kFloat32:
            std::memcpy(target, values.data(), values.size_bytes());
            break;
        case GridValueType::kFloat16:
            for (std::size_t i = 0; i < values.size(); ++i) {
                const std::uint16_t bits = imath_float_to_half(values[i]);
                std::memcpy(target + 2 * i, &bits, sizeof(bits));
            }
            break;
        case GridValueType::kUnorm8:
            for (std::size_t i = 0; i < values.size(); ++i)
                target[i] = static_cast<std::byte>(std::lround(255.0 * values[i] / header.scale));
            break;
    }
}

/// Occupancy bits, then the allocated bricks in table order.
std::vector<std::byte> sparsePayload(const DensityGrid& grid, const GridHeader& header) {
    const std::size_t bricks = grid.brickTable().size();
    std::vector<std::byte> payload(occupancyBytes(bricks), std::byte{0});
    payload.reserve(payload.size() + header.brickCount * DensityGrid::kBrickVoxels * bytesPerValue(header.valueType));
    for (std::size_t index = 0; index < bricks; ++index) {
        const std::span<const float> values = grid.brick(grid.brickAt(index));
        if (values.empty()) continue;
        payload[index / 8] |= std::byte{1} << (index % 8);
        appendValues(payload, values, header);
    }
    return payload;
}

float largestValue(const Volume& volume) {
    if (volume.channels == 1) return volume.density.maximum();
    return volume.color.values.empty() ? 0.0f : *std::ranges::max_element(volume.color.values);
}

GridHeader makeHeader(const Volume& volume, GridValueType type) {
    GridHeader header{};
    std::copy_n(kGridMagic, sizeof(header.magic), header.magic);
    header.version = kGridVersion;
    for (int axis = 0; axis < 3; ++axis) {
        header.resolution[axis] = resolutionOf(volume)[axis];
        header.boundsMin[axis] = volume.boundsMin[axis];
        header.boundsMax[axis] = volume.boundsMax[axis];
    }
    header.lattice = GridLattice::kCell;
    header.valueType = type;
    header.channels = static_cast<std::uint8_t>(volume.channels);
    header.layout = volume.channels == 1 ? GridLayout::kSparse : GridLayout::kDense;
    header.brickCount = volume.density.voxels().size() / DensityGrid::kBrickVoxels;
    header.scale = 1.0f;
    // An all-zero grid keeps 1: 0 / 0 is no byte.
    if (const float largest = largestValue(volume); type == GridValueType::kUnorm8 && largest > 0)
        header.scale = largest;
    return header;
}

}  // namespace

void writeGridVolume(const std::filesystem::path& file, const Volume& volume, GridValueType type) {
    if (const float largest = largestValue(volume); type == GridValueType::kFloat16 && largest > kLargestHalf)
        throw InputError(fmt::format("float16 holds values up to {}; got {}", kLargestHalf, largest));
    GridHeader header = makeHeader(volume, type);
    std::vector<std::byte> payload;
    if (header.layout == GridLayout::kSparse)
        payload = sparsePayload(volume.density, header);
    else
        appendValues(payload, volume.color.values, header);
    header.payloadBytes = payload.size();
    header.checksum = gridChecksum(header, payload);

    ByteWriter writer(file);
    writer.write(header);
    writer.write(payload.data(), payload.size());
    writer.close();
}

}  // namespace parhelion
