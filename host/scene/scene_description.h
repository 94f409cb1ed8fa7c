#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "image/bitmap.h"
#include "shared/cloud_types.h"
#include "volume/density_grid.h"

namespace parhelion {

/// A triangle mesh in its own space. Normals are empty or one a vertex.
struct Mesh {
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals;
    std::vector<glm::dvec2> uvs;  ///< empty or one a vertex
    std::vector<glm::uvec3> triangles;
    std::vector<std::string> notes;  ///< located: what its file holds and is left out
};

enum class ReconstructionFilter { Box, Tent, Gaussian };

struct FilmDescription {
    glm::uvec2 size{768, 576};  ///< Mitsuba's defaults
    std::optional<glm::uvec2> cropOffset, cropSize;
    ReconstructionFilter filter = ReconstructionFilter::Gaussian;
    bool samplesBorder = false;  ///< the filter reaches beyond the film; else it ends there (Mitsuba's sample_border)
    double filterRadius = 2.0;   ///< where it ends: 0.5 for box, 4 * stddev for Mitsuba's gaussian; pixels
    double filterStddev = 0.5;   ///< gaussian
};

/// How a field of view is measured.
enum class FovAxis { X, Y, Diagonal, Smaller, Larger };

struct CameraDescription {
    SourceLocation where;
    glm::dmat4 toWorld{1.0};  ///< camera looks along +z, +y up, +x left in the image
    double fovDegrees = 0.0;
    FovAxis fovAxis = FovAxis::X;          ///< of the film that is rendered, whose aspect may not be the scene's
    glm::dvec2 principalPointOffset{0.0};  ///< Mitsuba's principal_point_offset_x, _y
    std::optional<std::size_t> medium;     ///< that the sensor names; which one it is in follows from the shapes
    SourceLocation mediumWhere;
};

struct IntegratorDescription {
    std::string type = "volpath";  ///< direct | path | volpath; direct: `path` of depth 2 with the samples below
    double emitterSamples = 1;     ///< direct: weight of light sampling, 0: scattering alone
    double scatterSamples = 1;     ///< direct: weight of scattering, 0: light sampling alone
    unsigned depthLayers = 0;      ///< film layers by number of scatterings, the last for all above; 0: none
    std::int64_t maxDepth = -1;    ///< Mitsuba's meaning; -1: unlimited
    std::int64_t rouletteDepth = 5;

    static constexpr unsigned kMostDepthLayers = 64;
};

/// A colour over a surface's (u, v).
struct TextureDescription {
    enum class Type { Bitmap, Checkerboard } type = Type::Bitmap;
    enum class Wrap { Repeat, Mirror, Clamp } wrap = Wrap::Repeat;
    SourceLocation where;
    Bitmap bitmap;                        ///< linear; row 0 at v = 0
    bool nearest = false;                 ///< else bilinear
    glm::dmat3 uvTransform{1.0};          ///< (u', v', 1) = uvTransform * (u, v, 1)
    glm::dvec3 color0{0.4}, color1{0.2};  ///< checkerboard, Mitsuba's defaults
};

struct BsdfDescription {
    enum class Type { Diffuse, Null } type = Type::Diffuse;
    SourceLocation where;
    glm::dvec3 reflectance{0.5};         ///< tints the texture, if there is one
    std::optional<std::size_t> texture;  ///< index into textures
    bool twoSided = false;
};

struct PhaseDescription {
    enum class Type { Isotropic, HenyeyGreenstein, DualHenyeyGreenstein, Rayleigh, Tabulated } type = Type::Isotropic;
    SourceLocation where;
    double g = 0.0;
    double g2 = 0.0, lobeWeight = 1.0;  ///< dual: lobeWeight * HG(g) + (1 - lobeWeight) * HG(g2)
    std::vector<double> table;          ///< tabulated: values at equidistant mu from -1 to 1, mu = dot(-wo, wi)

    static constexpr std::size_t kMostTableValues = 65536;
};

/// A volume placed in the world: the unit cube under toWorld (Mitsuba's gridvolume).
struct GridPlacement {
    Volume volume;                            ///< with `cloud`: the density it modulates, if any
    std::optional<shared::CloudField> cloud;  ///< procedural density, to be baked before compileScene
    glm::dmat4 toWorld{1.0};  ///< grid-local [0, 1]^3 -> world, bounding box already included where asked for
    SourceLocation where;
};

/// Where a volume of one value lies: the unit cube under toWorld.
struct VolumeExtent {
    glm::dmat4 toWorld{1.0};
    SourceLocation where;
};

struct MediumDescription {
    std::string id;
    SourceLocation where;
    glm::dvec3 sigmaT{1.0};  ///< extinction at density 1, `scale` included [1/scene unit]
    glm::dvec3 albedo{0.75};
    std::optional<GridPlacement> density;
    std::optional<VolumeExtent> extent;       ///< without density: it exists within the world-aligned bounds of this
    std::optional<GridPlacement> albedoGrid;  ///< three channels, or one (grey); values in [0, 1]
    PhaseDescription phase;
};

struct ShapeDescription {
    enum class Type { Mesh, Rectangle, Cube, Sphere } type = Type::Mesh;
    std::string id;
    SourceLocation where;
    glm::dmat4 toWorld{1.0};
    glm::dvec3 center{0.0};  ///< sphere, before toWorld
    double radius = 1.0;     ///< sphere, before toWorld
    bool flipNormals = false;
    bool faceNormals = false;
    Mesh mesh;  ///< Type::Mesh
    BsdfDescription bsdf;
    std::optional<std::size_t> interior, exterior;  ///< indices into media
    std::optional<glm::dvec3> radiance;             ///< area emitter; tints the texture, if there is one
    std::optional<std::size_t> radianceTexture;     ///< index into textures
    bool emitsOnBothSides = false;                  ///< area emitter
};

/// The project's gradient sky with stars; see shared::Sky for the formula.
struct SkyDescription {
    glm::dvec3 axis{0.0, 1.0, 0.0};
    double offset = 0.0, width = 1.0, power = 1.0;
    glm::dvec3 top{0.0}, bottom{0.0};  ///< radiance
    double starDensity = 0.0;          ///< stars per steradian, on average
    double starSizeDegrees = 0.1;      ///< angular diameter
    glm::dvec3 starRadiance{1.0};      ///< of the brightest star there can be
    std::uint32_t starSeed = 0;
};

struct EmitterDescription {
    enum class Type { Directional, Point, Constant, EnvironmentMap, Sky } type = Type::Constant;
    SourceLocation where;
    glm::dvec3 value{1.0};             ///< irradiance, intensity or radiance
    glm::dvec3 vector{0.0, 0.0, 1.0};  ///< direction of travel (unit), or position
    Bitmap map;                        ///< environment map, linear; `value` scales it
    glm::dmat4 toWorld{1.0};           ///< environment map: its rotation
    bool misCompensation = false;      ///< environment map: sample what is above its mean only
    SkyDescription sky;
};

/// What the author wrote, checked value by value; every part keeps its location.
struct SceneDescription {
    std::filesystem::path file;
    std::vector<std::filesystem::path> files;  ///< all that were read: `file`, those it includes and those they name
    CameraDescription camera;
    FilmDescription film;
    IntegratorDescription integrator;
    std::uint64_t sampleCount = 4;  ///< Mitsuba's default
    std::uint32_t seed = 0;         ///< the sampler's
    std::vector<TextureDescription> textures;
    std::vector<MediumDescription> media;  ///< those that shapes use
    std::vector<ShapeDescription> shapes;
    std::vector<EmitterDescription> emitters;
    std::vector<std::string> notes;  ///< what was accepted but has no effect here, located
};

struct SceneReadOptions {
    std::map<std::string, std::string> defines;  ///< -D name=value: wins over <default>; Mitsuba only
    std::size_t volumeMemoryLimitBytes = 0;      ///< see VolumeReadOptions
};

/// Reads a scene in Mitsuba 3's or in Nori's dialect of XML, told apart by content.
/// @throws InputError with file:line:column for anything malformed, unknown or unsupported, naming what is allowed.
SceneDescription readScene(const std::filesystem::path& file, const SceneReadOptions& options = {});

}  // namespace parhelion
