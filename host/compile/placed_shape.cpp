#include "compile/placed_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include "compile/closed_mesh.h"
#include "compile/transforms.h"
#include "scene/transforms.h"

namespace parhelion {

namespace {

void placeSphere(PlacedShape& placed, const glm::dmat4& toScene) {
    const ShapeDescription& shape = *placed.source;
    const Similarity similarity = similarityOf(toScene);
    if (!similarity.holds)
        throw InputError(shape.where, nameOf(shape) +
                                          ": to_world must scale every axis alike (a sphere stays "
                                          "a sphere); use a mesh for an ellipsoid");
    placed.center = glm::dvec3(toScene * glm::dvec4(shape.center, 1.0));
    placed.radius = shape.radius * similarity.scale;
    if (!(placed.radius > 0.0))
        throw InputError(shape.where, fmt::format("{}: radius must be > 0; got {}", nameOf(shape), shape.radius));
    placed.volume = 4.0 / 3.0 * std::numbers::pi * placed.radius * placed.radius * placed.radius;
    placed.lower = placed.center - placed.radius;
    placed.upper = placed.center + placed.radius;
}

void placeCorners(PlacedShape& placed, int count) {
    for (int corner = 0; corner < count; ++corner) {
        const double z = count == 4 ? 0.0 : (corner & 4 ? 1.0 : -1.0);
        const glm::dvec4 local(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, z, 1.0);
        placed.vertices.emplace_back(placed.toScene * local);
    }
    if (count == 8) placed.volume = 8.0 * std::abs(glm::determinant(glm::dmat3(placed.toScene)));
}

void checkIndices(const ShapeDescription& shape) {
    const Mesh& mesh = shape.mesh;
    for (const glm::uvec3& triangle : mesh.triangles)
        for (int k = 0; k < 3; ++k)
            if (triangle[k] >= mesh.positions.size())
                throw InputError(shape.where, fmt::format("{}: triangles must name one of its {} vertices; got {}",
                                                          nameOf(shape), mesh.positions.size(), triangle[k]));
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
        throw InputError(shape.where, fmt::format("{}: a mesh has no normals or one for each of its {} vertices; got "
                                                  "{}",
                                                  nameOf(shape), mesh.positions.size(), mesh.normals.size()));
    if (!mesh.uvs.empty() && mesh.uvs.size() != mesh.positions.size())
        throw InputError(shape.where, fmt::format("{}: a mesh has no texture coordinates or one for each of its {} "
                                                  "vertices; got {}",
                                                  nameOf(shape), mesh.positions.size(), mesh.uvs.size()));
}

/// Divergence theorem, about a vertex of the mesh so that distance costs no digits.
double enclosedVolume(const PlacedShape& placed) {
    double sum = 0.0;
    for (const auto& [a, b, c] : surfaceOf(placed)) {
        const glm::dvec3 apex = placed.vertices[placed.triangles.front().x];
        sum += glm::dot(a - apex, glm::cross(b - apex, c - apex));
    }
    return sum / 6.0;
}

void placeMesh(PlacedShape& placed) {
    checkIndices(*placed.source);
    placed.vertices.reserve(placed.source->mesh.positions.size());
    for (const glm::dvec3& position : placed.source->mesh.positions)
        placed.vertices.emplace_back(placed.toScene * glm::dvec4(position, 1.0));
    placed.triangles = placed.source->mesh.triangles;
    placed.volume = enclosedVolume(placed);
}

void boundVertices(PlacedShape& placed) {
    placed.lower = glm::dvec3(std::numeric_limits<double>::infinity());
    placed.upper = -placed.lower;
    for (const glm::dvec3& vertex : placed.vertices) {
        placed.lower = glm::min(placed.lower, vertex);
        placed.upper = glm::max(placed.upper, vertex);
    }
    if (placed.vertices.empty()) placed.lower = placed.upper = glm::dvec3(0.0);
}

void checkMediumBoundary(PlacedShape& placed) {
    const ShapeDescription& shape = *placed.source;
    if (!placed.isNull() || !placed.mentionsMedia()) return;
    if (placed.kind == PlacedShape::Kind::Quad)
        throw InputError(shape.where, nameOf(shape) +
                                          ": a rectangle encloses nothing; a medium needs a sphere, a cube "
                                          "or a closed mesh");
    if (placed.isAnalyticSolid() && shape.flipNormals)
        throw InputError(shape.where, nameOf(shape) +
                                          ": flip_normals would put the interior medium outside, and "
                                          "unbounded media are not supported; remove it");
    if (placed.kind != PlacedShape::Kind::Mesh) return;
    placed.notes = closeMesh(placed);
    boundVertices(placed);  // some may have been moved
    std::ranges::move(checkInterior(placed), std::back_inserter(placed.notes));
}

}  // namespace

std::string nameOf(const ShapeDescription& shape) {
    static constexpr const char* kNames[] = {"mesh", "rectangle", "cube", "sphere"};
    const std::string kind = kNames[static_cast<int>(shape.type)];
    return shape.id.empty() ? kind : fmt::format("{} \"{}\"", kind, shape.id);
}

std::array<glm::dvec3, 3> cornersOf(const PlacedShape& mesh, std::uint32_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    std::array<glm::dvec3, 3> corners{mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]};
    if (mesh.source->flipNormals) std::swap(corners[1], corners[2]);
    return corners;
}

std::vector<std::array<glm::dvec3, 3>> surfaceOf(const PlacedShape& shape) {
    std::vector<std::array<glm::dvec3, 3>> triangles;
    for (std::uint32_t t = 0; t < shape.triangles.size(); ++t) triangles.push_back(cornersOf(shape, t));
    if (shape.kind != PlacedShape::Kind::Box) return triangles;
    for (const auto& face : kBoxFaces)
        for (const int k : {1, 2}) {
            triangles.push_back({shape.vertices[face[0]], shape.vertices[face[k]], shape.vertices[face[k + 1]]});
            if (shape.mirrored) std::swap(triangles.back()[1], triangles.back()[2]);
        }
    return triangles;
}

PlacedShape placeShape(const ShapeDescription& shape, const glm::dvec3& worldOrigin) {
    PlacedShape placed;
    placed.source = &shape;
    requireInvertible(shape.toWorld, shape.where, nameOf(shape));
    placed.toScene = relativeTo(shape.toWorld, worldOrigin);
    placed.mirrored = glm::determinant(glm::dmat3(shape.toWorld)) < 0.0;
    if (placed.isNull() && shape.radiance)
        throw InputError(shape.where, nameOf(shape) + ": an area light needs a surface; a null BSDF has none");

    switch (shape.type) {
        case ShapeDescription::Type::Sphere:
            placed.kind = PlacedShape::Kind::Sphere;
            placeSphere(placed, placed.toScene);
            break;
        case ShapeDescription::Type::Rectangle:
            placed.kind = PlacedShape::Kind::Quad;
            placeCorners(placed, 4);
            boundVertices(placed);
            break;
        case ShapeDescription::Type::Cube:
            placed.kind = PlacedShape::Kind::Box;
            placeCorners(placed, 8);
            boundVertices(placed);
            break;
        case ShapeDescription::Type::Mesh:
            placed.kind = PlacedShape::Kind::Mesh;
            placeMesh(placed);
            boundVertices(placed);
            break;
    }
    checkMediumBoundary(placed);
    return placed;
}

}  // namespace parhelion
