#include "volume/sparse_volume.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>

namespace parhelion {

namespace {

struct Box {
    glm::i64vec3 min{std::numeric_limits<std::int64_t>::max()};
    glm::i64vec3 max{std::numeric_limits<std::int64_t>::min()};

    void include(glm::i64vec3 low, glm::i64vec3 high) {
        min = glm::min(min, low);
        max = glm::max(max, high);
    }
};

/// Position of value `index` in its leaf: z fastest.
glm::i64vec3 leafPosition(unsigned index) { return {index / 64, index / 8 % 8, index % 8}; }

Box activeBox(const SparseTree& tree) {
    Box box;
    for (const SparseTree::Tile& tile : tree.activeTiles) box.include(tile.origin, tile.origin + (tile.edge - 1));
    for (const SparseTree::Leaf& leaf : tree.leaves) {
        for (unsigned i = 0; i < kLeafVoxels; ++i) {
            const glm::i64vec3 voxel = leaf.origin + leafPosition(i);
            if (isOn(leaf.active, i)) box.include(voxel, voxel);
        }
    }
    return box;
}

}  // namespace

GridTransform makeGridTransform(const SourceLocation& where, const std::array<double, 9>& matrix,
                                const glm::dvec3& translation) {
    for (int i = 0; i < 9; ++i) {
        // What rounding leaves of a rotation by full turns.
        const double tolerance = 1e-12 * std::abs(matrix[i / 3 * 4]);
        if (i % 4 != 0 && !(std::abs(matrix[i]) <= tolerance))
            throw InputError(where, "the grid's transform must not rotate or shear; resample it along the axes");
    }
    const GridTransform transform{{matrix[0], matrix[4], matrix[8]}, translation};
    for (int axis = 0; axis < 3; ++axis) {
        const double size = transform.voxelSize[axis];
        if (!std::isfinite(size) || size <= 0 || !std::isfinite(translation[axis]))
            throw InputError(where, fmt::format("voxel size must be finite and > 0, the origin finite; got {} and {} "
                                                "on axis {}",
                                                size, translation[axis], "xyz"[axis]));
    }
    return transform;
}

SparseVolumeBuilder::SparseVolumeBuilder(const SparseTree& tree, const VolumeBytes& input)
    : tree_(tree), where_(input.where), inactiveNonZero_(tree.inactiveNonZero) {
    const Box box = activeBox(tree);
    if (box.max.x < box.min.x)
        throw InputError(where_, fmt::format("grid \"{}\" must have active voxels; got none", tree.gridName));
    boxMin_ = box.min;
    boxMax_ = box.max;
    const glm::i64vec3 size = boxMax_ - boxMin_ + std::int64_t(1);
    checkResolution(where_, size);
    // The table alone first: counting bricks takes a bit for each.
    checkMemory(where_, gridBytes(size, 0), input.options.memoryLimitBytes);
    const std::uint64_t bricks = countBricks();
    checkMemory(where_, gridBytes(size, bricks), input.options.memoryLimitBytes);

    volume_.density = DensityGrid(size);
    volume_.density.reserveBricks(bricks);
    const GridTransform& transform = tree.transform;
    volume_.boundsMin = transform.voxelSize * (glm::dvec3(boxMin_) - 0.5) + transform.translation;
    volume_.boundsMax = transform.voxelSize * (glm::dvec3(boxMax_) + 0.5) + transform.translation;
    checkBounds(where_, volume_.boundsMin, volume_.boundsMax);
    for (const SparseTree::Tile& tile : tree.activeTiles) fillTile(tile);
}

std::uint64_t SparseVolumeBuilder::countBricks() const {
    const glm::i64vec3 counts = (boxMax_ - boxMin_) / std::int64_t(DensityGrid::kBrickSize) + std::int64_t(1);
    std::vector<bool> marked(counts.x * counts.y * counts.z, false);
    std::uint64_t total = 0;
    const auto mark = [&](glm::i64vec3 low, glm::i64vec3 high) {
        const glm::i64vec3 first = (glm::max(low, boxMin_) - boxMin_) / std::int64_t(DensityGrid::kBrickSize);
        const glm::i64vec3 last = (glm::min(high, boxMax_) - boxMin_) / std::int64_t(DensityGrid::kBrickSize);
        if (glm::any(glm::lessThan(glm::min(high, boxMax_), glm::max(low, boxMin_)))) return;
        for (std::int64_t z = first.z; z <= last.z; ++z) {
            for (std::int64_t y = first.y; y <= last.y; ++y) {
                for (std::int64_t x = first.x; x <= last.x; ++x) {
                    const std::size_t index = (z * counts.y + y) * counts.x + x;
                    total += !marked[index];
                    marked[index] = true;
                }
            }
        }
    };
    for (const SparseTree::Tile& tile : tree_.activeTiles)
        if (tile.value != 0.0f) mark(tile.origin, tile.origin + (tile.edge - 1));
    for (const SparseTree::Leaf& leaf : tree_.leaves) mark(leaf.origin, leaf.origin + std::int64_t(kLeafEdge - 1));
    return total;
}

void SparseVolumeBuilder::fillTile(const SparseTree::Tile& tile) {
    checkValue(where_, tile.value, tile.origin);
    if (tile.value == 0.0f) return;
    const glm::uvec3 first = tile.origin - boxMin_;
    const glm::uvec3 end = first + static_cast<unsigned>(tile.edge);
    for (unsigned z = first.z; z < end.z; ++z)
        for (unsigned y = first.y; y < end.y; ++y)
            for (unsigned x = first.x; x < end.x; ++x) volume_.density.set({x, y, z}, tile.value);
}

void SparseVolumeBuilder::addLeaf(const SparseTree::Leaf& leaf, const float* values) {
    const glm::i64vec3 offset = leaf.origin - boxMin_;
    for (unsigned i = 0; i < kLeafVoxels; ++i) {
        if (isOn(leaf.active, i)) {
            checkValue(where_, values[i], leaf.origin + leafPosition(i));
            if (values[i] != 0.0f) volume_.density.set(glm::uvec3(offset + leafPosition(i)), values[i]);
        } else {
            inactiveNonZero_ += values[i] != 0.0f && values[i] != tree_.background;
        }
    }
}

Volume SparseVolumeBuilder::finish() {
    volume_.source = fmt::format("grid \"{}\"", tree_.gridName);
    std::vector<std::string> notes;
    if (!tree_.note.empty()) notes.push_back(tree_.note);
    if (tree_.background != 0.0f)
        notes.push_back(fmt::format("the background value {} was read as 0", tree_.background));
    if (inactiveNonZero_ > 0)
        notes.push_back(fmt::format("{} inactive voxels with other values than 0 were read as 0", inactiveNonZero_));
    volume_.note = fmt::format("{}", fmt::join(notes, "; "));
    return std::move(volume_);
}

}  // namespace parhelion
