#include "volume/density_grid.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace parhelion {

namespace {

std::size_t offsetInBrick(glm::uvec3 voxel) {
    const glm::uvec3 local = voxel % DensityGrid::kBrickSize;
    return (local.z * DensityGrid::kBrickSize + local.y) * DensityGrid::kBrickSize + local.x;
}

/// Copies the part of a dense array that a brick covers; false when it is all zero.
bool gatherBrick(glm::uvec3 resolution, std::span<const float> values, glm::uvec3 first, std::span<float> brick) {
    const glm::uvec3 end = glm::min(first + DensityGrid::kBrickSize, resolution);
    bool occupied = false;
    std::fill(brick.begin(), brick.end(), 0.0f);
    for (unsigned z = first.z; z < end.z; ++z) {
        for (unsigned y = first.y; y < end.y; ++y) {
            const float* row = values.data() + (std::size_t(z) * resolution.y + y) * resolution.x + first.x;
            float* target = brick.data() + offsetInBrick({0, y, z});
            for (unsigned x = 0; x < end.x - first.x; ++x) {
                target[x] = row[x];
                occupied |= row[x] != 0.0f;
            }
        }
    }
    return occupied;
}

}  // namespace

DensityGrid::DensityGrid(glm::uvec3 resolution)
    : resolution_(resolution), brickCounts_((resolution + (kBrickSize - 1)) / kBrickSize) {
    assert(glm::all(glm::greaterThanEqual(resolution, glm::uvec3(1))));
    assert(glm::all(glm::lessThanEqual(resolution, glm::uvec3(kMaxResolution))));
    table_.assign(std::size_t(brickCounts_.x) * brickCounts_.y * brickCounts_.z, kEmpty);
}

DensityGrid DensityGrid::fromDense(glm::uvec3 resolution, std::span<const float> values) {
    DensityGrid grid(resolution);
    grid.reserveBricks(countOccupiedBricks(resolution, values));
    std::array<float, kBrickVoxels> gathered;
    for (std::size_t index = 0; index < grid.table_.size(); ++index) {
        const glm::uvec3 brick = grid.brickAt(index);
        if (gatherBrick(resolution, values, brick * kBrickSize, gathered))
            std::copy(gathered.begin(), gathered.end(), grid.allocateBrick(brick).begin());
    }
    return grid;
}

std::size_t DensityGrid::countOccupiedBricks(glm::uvec3 resolution, std::span<const float> values) {
    assert(values.size() == std::size_t(resolution.x) * resolution.y * resolution.z);
    std::array<float, kBrickVoxels> gathered;
    std::size_t count = 0;
    for (unsigned z = 0; z < resolution.z; z += kBrickSize)
        for (unsigned y = 0; y < resolution.y; y += kBrickSize)
            for (unsigned x = 0; x < resolution.x; x += kBrickSize)
                count += gatherBrick(resolution, values, {x, y, z}, gathered);
    return count;
}

std::size_t DensityGrid::brickIndex(glm::uvec3 brick) const {
    assert(glm::all(glm::lessThan(brick, brickCounts_)));
    return (std::size_t(brick.z) * brickCounts_.y + brick.y) * brickCounts_.x + brick.x;
}

glm::uvec3 DensityGrid::brickAt(std::size_t index) const {
    const std::size_t row = index / brickCounts_.x;
    return {index % brickCounts_.x, row % brickCounts_.y, row / brickCounts_.y};
}

std::span<float> DensityGrid::allocateBrick(glm::uvec3 brick) {
    std::uint32_t& entry = table_[brickIndex(brick)];
    if (entry == kEmpty) {
        entry = static_cast<std::uint32_t>(voxels_.size() / kBrickVoxels);
        voxels_.resize(voxels_.size() + kBrickVoxels, 0.0f);
    }
    return std::span(voxels_).subspan(std::size_t(entry) * kBrickVoxels, kBrickVoxels);
}

std::span<const float> DensityGrid::brick(glm::uvec3 brick) const {
    const std::uint32_t entry = table_[brickIndex(brick)];
    if (entry == kEmpty) return {};
    return std::span(voxels_).subspan(std::size_t(entry) * kBrickVoxels, kBrickVoxels);
}

void DensityGrid::reserveBricks(std::size_t count) { voxels_.reserve(count * kBrickVoxels); }

float DensityGrid::at(glm::uvec3 voxel) const {
    assert(glm::all(glm::lessThan(voxel, resolution_)));
    const std::span<const float> values = brick(voxel / kBrickSize);
    return values.empty() ? 0.0f : values[offsetInBrick(voxel)];
}

void DensityGrid::set(glm::uvec3 voxel, float value) {
    assert(glm::all(glm::lessThan(voxel, resolution_)));
    const glm::uvec3 owner = voxel / kBrickSize;
    if (value == 0.0f && table_[brickIndex(owner)] == kEmpty) return;
    allocateBrick(owner)[offsetInBrick(voxel)] = value;
}

float DensityGrid::maximum() const {
    // Padding of border bricks is zero and values are >= 0, so it never wins.
    return voxels_.empty() ? 0.0f : *std::max_element(voxels_.begin(), voxels_.end());
}

double DensityGrid::interpolate(glm::dvec3 p) const {
    const glm::dvec3 last(resolution_ - 1u);
    const glm::dvec3 s = glm::clamp(p - 0.5, glm::dvec3(0.0), last);
    const glm::uvec3 low(s);
    const glm::uvec3 high = glm::min(low + 1u, resolution_ - 1u);
    const glm::dvec3 f = s - glm::dvec3(low);

    const auto alongX = [&](unsigned y, unsigned z) {
        return (1 - f.x) * at({low.x, y, z}) + f.x * at({high.x, y, z});
    };
    const auto alongY = [&](unsigned z) { return (1 - f.y) * alongX(low.y, z) + f.y * alongX(high.y, z); };
    return (1 - f.z) * alongY(low.z) + f.z * alongY(high.z);
}

std::vector<float> DensityGrid::toDense() const {
    std::vector<float> dense(std::size_t(resolution_.x) * resolution_.y * resolution_.z, 0.0f);
    for (std::size_t index = 0; index < table_.size(); ++index) {
        const glm::uvec3 first = brickAt(index) * kBrickSize;
        const std::span<const float> values = brick(first / kBrickSize);
        if (values.empty()) continue;
        const glm::uvec3 end = glm::min(first + kBrickSize, resolution_);
        for (unsigned z = first.z; z < end.z; ++z) {
            for (unsigned y = first.y; y < end.y; ++y) {
                const float* row = values.data() + offsetInBrick({0, y, z});
                std::copy(row, row + (end.x - first.x),
                          dense.data() + (std::size_t(z) * resolution_.y + y) * resolution_.x + first.x);
            }
        }
    }
    return dense;
}

}  // namespace parhelion
