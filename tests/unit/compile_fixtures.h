#pragma once

#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <utility>

#include "compile/compile_scene.h"

/// Descriptions of small scenes, as readScene would return them.
namespace parhelion::fixtures {

inline glm::dmat4 translation(const glm::dvec3& offset) { return glm::translate(glm::dmat4(1.0), offset); }

inline glm::dmat4 scaling(const glm::dvec3& factors) { return glm::scale(glm::dmat4(1.0), factors); }

inline ShapeDescription shape(ShapeDescription::Type type, const std::string& id, const glm::dmat4& toWorld) {
    ShapeDescription result;
    result.type = type;
    result.id = id;
    result.toWorld = toWorld;
    result.where = {id + ".xml", 7, 5};
    return result;
}

inline ShapeDescription sphere(const std::string& id, const glm::dvec3& center, double radius) {
    return shape(ShapeDescription::Type::Sphere, id, translation(center) * scaling(glm::dvec3(radius)));
}

/// Axis-aligned, of the given half size.
inline ShapeDescription cube(const std::string& id, const glm::dvec3& center, const glm::dvec3& halfSize) {
    return shape(ShapeDescription::Type::Cube, id, translation(center) * scaling(halfSize));
}

inline ShapeDescription rectangle(const std::string& id, const glm::dmat4& toWorld = glm::dmat4(1.0)) {
    return shape(ShapeDescription::Type::Rectangle, id, toWorld);
}

/// The tetrahedron of the origin and the unit axes, with outward triangles.
inline ShapeDescription tetrahedron(const std::string& id, const glm::dmat4& toWorld = glm::dmat4(1.0)) {
    ShapeDescription result = shape(ShapeDescription::Type::Mesh, id, toWorld);
    result.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    result.mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return result;
}

/// Adds a cube of 12 outward triangles to a mesh; `split`: no face shares its vertices, as files with normals have it.
inline void addCube(Mesh& mesh, const glm::dvec3& center, const glm::dvec3& halfSize, bool split = false,
                    bool inwards = false) {
    constexpr unsigned kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    const auto first = unsigned(mesh.positions.size());
    const auto corner = [&](unsigned bits) {
        return center + halfSize * (2.0 * glm::dvec3(bits & 1u, bits >> 1 & 1u, bits >> 2 & 1u) - 1.0);
    };
    for (unsigned bits = 0; bits < 8 && !split; ++bits) mesh.positions.push_back(corner(bits));
    for (const auto& face : kFaces) {
        unsigned v[4];
        for (int k = 0; k < 4; ++k) {
            v[k] = split ? unsigned(mesh.positions.size()) : first + face[k];
            if (split) mesh.positions.push_back(corner(face[k]));
        }
        if (inwards) std::swap(v[1], v[3]);
        mesh.triangles.insert(mesh.triangles.end(), {{v[0], v[1], v[2]}, {v[0], v[2], v[3]}});
    }
}

inline ShapeDescription meshOf(const std::string& id, Mesh mesh, const glm::dmat4& toWorld = glm::dmat4(1.0)) {
    ShapeDescription result = shape(ShapeDescription::Type::Mesh, id, toWorld);
    result.mesh = std::move(mesh);
    return result;
}

inline ShapeDescription meshCube(const std::string& id, const glm::dvec3& center, const glm::dvec3& halfSize) {
    Mesh mesh;
    addCube(mesh, center, halfSize);
    return meshOf(id, std::move(mesh));
}

/// A mesh from the vertices of its triangles, one after the other.
inline ShapeDescription soup(const std::string& id, const std::vector<glm::vec3>& vertices) {
    ShapeDescription result = shape(ShapeDescription::Type::Mesh, id, glm::dmat4(1.0));
    for (const glm::vec3& vertex : vertices) {
        const auto index = std::uint32_t(result.mesh.positions.size());
        if (index % 3 == 0) result.mesh.triangles.emplace_back(index, index + 1, index + 2);
        result.mesh.positions.emplace_back(vertex);
    }
    return result;
}

/// Turns a shape into a medium boundary.
inline ShapeDescription boundary(ShapeDescription shape, std::size_t interior) {
    shape.bsdf.type = BsdfDescription::Type::Null;
    shape.interior = interior;
    return shape;
}

inline ShapeDescription boundary(ShapeDescription shape, std::size_t interior, std::size_t exterior) {
    shape = boundary(std::move(shape), interior);
    shape.exterior = exterior;
    return shape;
}

inline ShapeDescription emissive(ShapeDescription shape, const glm::dvec3& radiance) {
    shape.radiance = radiance;
    return shape;
}

inline MediumDescription medium(const std::string& id) {
    MediumDescription result;
    result.id = id;
    result.where = {"media.xml", 3, 3};
    return result;
}

inline MediumDescription gridMedium(const std::string& id, const DensityGrid& grid) {
    MediumDescription result = medium(id);
    result.density = GridPlacement{};
    result.density->volume.density = grid;
    return result;
}

/// A camera at (0, 0, -10) that looks along +z at an empty scene, with the pixel's box as its filter.
inline SceneDescription scene() {
    SceneDescription result;
    result.file = "scene.xml";
    result.camera.toWorld = translation({0, 0, -10});
    result.camera.fovDegrees = 40.0;
    result.film.size = {32, 32};
    result.film.filter = ReconstructionFilter::Box;
    result.film.filterRadius = 0.5;
    return result;
}

/// The message of the InputError that compiling throws; empty if it throws none.
inline std::string inputErrorOf(const SceneDescription& description, const CompileOptions& options = {}) {
    try {
        compileScene(description, options);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace parhelion::fixtures
