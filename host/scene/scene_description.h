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
#include "volume/density_grid.h"

namespace parhelion {

/// A triangle mesh in its own space. Normals are empty or one a vertex.
struct Mesh {
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals;
    std::vector<glm::dvec2> uvs;  ///< empty or one a vertex
    std::vector<glm::uvec3> triangles;
};

enum class ReconstructionFilter { Box, Tent, Gaussian };

struct FilmDescription {
    glm::uvec2 size{768, 576};  ///< Mitsuba's defaults
    std::optional<glm::uvec2> cropOffset, cropSize;
    ReconstructionFilter filter = ReconstructionFilter::Gaussian;
    double filterRadius = 2.0;  ///< 0.5 for box, tent radius, or 4 * stddev for gaussian; pixels
    double filterStddev = 0.5;  ///< gaussian
};

struct CameraDescription {
    SourceLocation where;
    glm::dmat4 toWorld{1.0};               ///< camera looks along +z, +y up, +x left in the image
    double fovXDegrees = 0.0;              ///< horizontal, resolved from every fov rule and the film's aspect
    glm::dvec2 principalPointOffset{0.0};  ///< Mitsuba's principal_point_offset_x, _y
};

struct IntegratorDescription {
    std::string type = "volpath";  ///< path | volpath
    std::int64_t maxDepth = -1;    ///< Mitsuba's meaning; -1: unlimited
    std::int64_t rouletteDepth = 5;
};

struct BsdfDescription {
    enum class Type { Diffuse, Null } type = Type::Diffuse;
    SourceLocation where;
    glm::dvec3 reflectance{0.5};
    bool twoSided = false;
};

struct PhaseDescription {
    enum class Type { Isotropic, HenyeyGreenstein } type = Type::Isotropic;
    SourceLocation where;
    double g = 0.0;
};

/// A volume placed in the world: the unit cube under toWorld (Mitsuba's gridvolume).
struct GridPlacement {
    Volume volume;
    glm::dmat4 toWorld{1.0};  ///< grid-local [0, 1]^3 -> world, bounding box already included where asked for
    SourceLocation where;
};

struct MediumDescription {
    std::string id;
    SourceLocation where;
    glm::dvec3 sigmaT{1.0};  ///< extinction at density 1, `scale` included [1/scene unit]
    glm::dvec3 albedo{0.75};
    std::optional<GridPlacement> density;
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
    std::optional<glm::dvec3> radiance;             ///< area emitter
};

struct EmitterDescription {
    enum class Type { Directional, Point, Constant } type = Type::Constant;
    SourceLocation where;
    glm::dvec3 value{1.0};             ///< irradiance, intensity or radiance
    glm::dvec3 vector{0.0, 0.0, 1.0};  ///< direction of travel (unit), or position
};

/// What the author wrote, checked value by value; every part keeps its location.
struct SceneDescription {
    std::filesystem::path file;
    CameraDescription camera;
    FilmDescription film;
    IntegratorDescription integrator;
    std::uint64_t sampleCount = 4;         ///< Mitsuba's default
    std::uint32_t seed = 0;                ///< the sampler's
    std::vector<MediumDescription> media;  ///< those that shapes use
    std::vector<ShapeDescription> shapes;
    std::vector<EmitterDescription> emitters;
    std::vector<std::string> notes;  ///< what was accepted but has no effect here, located
};

struct SceneReadOptions {
    std::map<std::string, std::string> defines;  ///< -D name=value: wins over <default>
    std::size_t volumeMemoryLimitBytes = 0;      ///< see VolumeReadOptions
};

/// Reads a Mitsuba 3 XML scene.
/// @throws InputError with file:line:column for anything malformed, unknown or unsupported, naming what is allowed.
SceneDescription readScene(const std::filesystem::path& file, const SceneReadOptions& options = {});

}  // namespace parhelion
