#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "volume/volume_checks.h"
#include "volume/volume_formats.h"

namespace parhelion {

constexpr unsigned kLeafEdge = 8;
constexpr unsigned kLeafVoxels = kLeafEdge * kLeafEdge * kLeafEdge;

/// True for voxel `index` of an OpenVDB or NanoVDB node mask (64-bit words, little endian).
inline bool isOn(const std::byte* mask, std::size_t index) {
    return (static_cast<unsigned>(mask[index / 8]) >> (index % 8) & 1u) != 0;
}

/// Where the voxels of a VDB grid lie in the world.
struct GridTransform {
    glm::dvec3 voxelSize{1.0};    ///< world units
    glm::dvec3 translation{0.0};  ///< world position of the centre of voxel 0
};

/// @param matrix  3x3, index to world; the order of storage does not matter for those allowed.
/// @throws InputError unless the transform is a finite scale > 0 per axis and a finite translation.
GridTransform makeGridTransform(const SourceLocation& where, const std::array<double, 9>& matrix,
                                const glm::dvec3& translation);

/// The structure of a VDB tree, in the file's index space: voxel i is sampled at index i, so its box is i -+ 0.5.
struct SparseTree {
    struct Leaf {
        glm::i64vec3 origin;
        const std::byte* active;  ///< mask of kLeafVoxels bits, owned by the file's bytes
    };
    /// A cube of voxels of one value.
    struct Tile {
        glm::i64vec3 origin;
        std::int64_t edge;
        float value;
    };

    std::string gridName;
    std::string note;  ///< on the choice of the grid, or empty
    GridTransform transform;
    float background = 0;
    std::vector<Leaf> leaves;
    std::vector<Tile> activeTiles;
    std::uint64_t inactiveNonZero = 0;  ///< voxels under inactive tiles of a value other than 0 or the background
};

/// Moves a VDB tree into a Volume over the box of its active voxels. Inactive voxels become 0, as in a fog
/// volume, and Volume::note says so when the file gave them another value.
class SparseVolumeBuilder {
public:
    /// Fills the tiles.
    /// @throws InputError for an empty tree, and for a box or a memory need beyond the limits (before allocating).
    SparseVolumeBuilder(const SparseTree& tree, const VolumeBytes& input);

    /// @param values  kLeafVoxels values, z fastest (the order of both file formats).
    /// @throws InputError naming the voxel (in index space) when an active value is negative or not finite.
    void addLeaf(const SparseTree::Leaf& leaf, const float* values);

    Volume finish();

private:
    std::uint64_t countBricks() const;
    void fillTile(const SparseTree::Tile& tile);

    const SparseTree& tree_;
    SourceLocation where_;
    glm::i64vec3 boxMin_;
    glm::i64vec3 boxMax_;  ///< inclusive
    std::uint64_t inactiveNonZero_;
    Volume volume_;
};

}  // namespace parhelion
