#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "shared/effects.h"
#include "shared/quality.h"
#include "shared/scene_types.h"

namespace parhelion {

/// What a texel buffer can address: the least of the devices there are.
inline constexpr std::size_t kMaxTexels = std::size_t(1) << 27;

/// One bit an effect of shaders/shared/effects.h.
enum class Effect : unsigned {
#define X(name, id, label) name = id,
    PARHELION_EFFECTS(X)
#undef X
};
inline constexpr unsigned kEffectCount = 0
#define X(name, id, label) +1
    PARHELION_EFFECTS(X)
#undef X
    ;

/// Which effects a scene calls for, with the reason for each, on or off.
struct EffectSet {
    std::bitset<kEffectCount> on;
    std::array<std::string, kEffectCount> reasons;

    bool has(Effect effect) const { return on[static_cast<unsigned>(effect)]; }
    static EffectSet all();
};

/// shaders/shared/quality.h as values.
struct Quality {
    using uint = std::uint32_t;
#define X(name, id, type, value, label) type name = value;
    PARHELION_QUALITY(X)
#undef X
};

/// What one array of a CompiledScene costs.
struct ArraySize {
    std::string_view name;
    std::size_t bytes;
};

/// Canonical, device-ready arrays: all that either back end reads.
struct CompiledScene {
    shared::SceneConstants constants{};
    std::vector<shared::Shape> shapes;      ///< by shape index
    std::vector<glm::vec4> bvhNodes;        ///< kBvhNodeTexels a node; empty without triangles
    std::vector<glm::vec4> triangles;       ///< kTriangleTexels a triangle, BVH order
    std::vector<glm::vec4> vertexNormals;   ///< 3 a triangle; empty when every triangle is flat
    std::vector<float> density;             ///< all density voxels; dense: x fastest; bricked: 512 a brick
    std::vector<std::uint32_t> brickTable;  ///< first voxel of each brick in `density`, or kEmptyBrick
    std::vector<float> majorants;           ///< density bound per majorant cell
    std::vector<glm::vec4> albedoVoxels;    ///< rgb + unused
    std::vector<float> triangleAreas;  ///< of mesh lights' triangles, area / probability; empty without such lights
    std::vector<std::uint32_t> lightTriangles;  ///< of mesh lights: primitive ids (global numbering)
    std::vector<float> filterTable;             ///< 257 offsets in pixels; empty for the box filter
    std::vector<shared::Texture> textures;
    std::vector<glm::vec4> textureTexels;      ///< rgb + unused, all bitmaps one after the other
    std::vector<glm::vec2> triangleUvs;        ///< 3 a triangle; empty where no shape is textured
    std::vector<float> phaseTable;             ///< tabulated phase functions, see Medium.phaseOffset
    std::vector<glm::vec4> environmentTexels;  ///< rgb; w: density per steradian of the cell whose corner it is
    std::vector<glm::uvec2> distributions;     ///< (edge, guide), one table after the other: see DistributionTable
    std::vector<glm::vec2> environmentRows;    ///< of each row of cells: 1 - cos of the angle between the nearer pole
                                               ///< and the edge nearer to it; how much cos changes over the row
    std::vector<float> skyBands;               ///< density per steradian of each band
    std::vector<glm::vec4> stars;              ///< 2 a star: direction and 1 - cos of its radius; brightness, density
    std::vector<std::uint32_t> starCells;      ///< lookup grid: runs of star indices
    EffectSet effects;

    glm::uvec2 filmSize{0};
    glm::uvec2 cropOffset{0}, cropSize{0};
    std::uint64_t sampleCount = 16;
    std::uint32_t seed = 0;          ///< the scene's choice of random numbers
    double radianceUnit = 1.0;       ///< a power of two: what 1 stands for in the radiance of lights and film
    glm::dvec3 worldOrigin{0.0};     ///< world position of this scene's origin (the camera)
    std::vector<std::string> notes;  ///< what a user should know (dropped lights, ...)

    /// Bytes of each array, by name, in the order above.
    std::vector<ArraySize> arraySizes() const;
    std::size_t memoryBytes() const;
};

}  // namespace parhelion
