#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace parhelion {

/// A scalar field on nx * ny * nz voxels, kept in bricks of 8^3; bricks of zeros take no memory.
///
/// Voxel (i, j, k) has its centre at (i, j, k) + 0.5 in voxel units; the field between centres is
/// trilinear and constant (clamped) beyond the outermost centres. Values are unitless, finite, >= 0.
class DensityGrid {
public:
    static constexpr unsigned kBrickSize = 8;
    static constexpr unsigned kBrickVoxels = kBrickSize * kBrickSize * kBrickSize;
    static constexpr unsigned kMaxResolution = 8192;  ///< voxels per axis
    static constexpr std::uint32_t kEmpty = 0xffffffffu;

    DensityGrid() = default;
    /// An all-zero grid. Each of `resolution` must be in [1, 8192].
    explicit DensityGrid(glm::uvec3 resolution);

    /// From dense values, x fastest, size nx * ny * nz.
    static DensityGrid fromDense(glm::uvec3 resolution, std::span<const float> values);
    /// How many bricks of dense values hold something other than zero.
    static std::size_t countOccupiedBricks(glm::uvec3 resolution, std::span<const float> values);

    glm::uvec3 resolution() const { return resolution_; }
    glm::uvec3 brickCounts() const { return brickCounts_; }
    float at(glm::uvec3 voxel) const;
    void set(glm::uvec3 voxel, float value);  ///< allocates the brick when value != 0
    float maximum() const;
    /// Trilinear value at p in voxel units ([0, resolution]), clamped outside.
    double interpolate(glm::dvec3 p) const;

    /// The 512 values of a brick (x fastest), allocated as zeros on first use; the span is invalidated
    /// by the next allocation. Values beyond the resolution (border bricks) must stay zero.
    std::span<float> allocateBrick(glm::uvec3 brick);
    /// The 512 values of a brick, or an empty span when it holds only zeros.
    std::span<const float> brick(glm::uvec3 brick) const;
    /// Takes memory for `count` bricks at once.
    void reserveBricks(std::size_t count);
    /// The brick at position `index` of brickTable().
    glm::uvec3 brickAt(std::size_t index) const;

    /// All values, x fastest. Costs 4 * nx * ny * nz bytes.
    std::vector<float> toDense() const;

    /// Index into voxels() / 512 per brick, x fastest, or kEmpty.
    std::span<const std::uint32_t> brickTable() const { return table_; }
    /// Allocated bricks, 512 values each, x fastest inside the brick.
    std::span<const float> voxels() const { return voxels_; }
    std::size_t memoryBytes() const { return voxels_.size() * sizeof(float) + table_.size() * 4; }

private:
    std::size_t brickIndex(glm::uvec3 brick) const;

    glm::uvec3 resolution_{0};
    glm::uvec3 brickCounts_{0};
    std::vector<std::uint32_t> table_;
    std::vector<float> voxels_;
};

/// A three-channel field (albedo), dense, x fastest, rgb interleaved; same lattice as DensityGrid.
struct ColorGrid {
    glm::uvec3 resolution{0};
    std::vector<float> values;  ///< 3 * nx * ny * nz
};

/// What a volume file says: one scalar or one three-channel field and its bounds.
struct Volume {
    DensityGrid density;  ///< used when channels == 1
    ColorGrid color;      ///< used when channels == 3
    unsigned channels = 1;
    glm::dvec3 boundsMin{0.0};  ///< as the file states them; [0, 1]^3 when it states none
    glm::dvec3 boundsMax{1.0};
    std::string source;  ///< file and grid name, for messages
    std::string note;    ///< anything a user should know (clamped background, dropped grids), or empty
};

}  // namespace parhelion
