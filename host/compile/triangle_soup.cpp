#include "compile/triangle_soup.h"

#include <algorithm>
#include <utility>

#include "compile/transforms.h"

namespace parhelion {

namespace {

glm::dvec3 doubledNormal(const TriangleVertices& t) {
    return glm::cross(glm::dvec3(t[1]) - glm::dvec3(t[0]), glm::dvec3(t[2]) - glm::dvec3(t[0]));
}

/// Area^2 <= 1e-30 L^4: no direction of its normal is left in double (H45).
bool isDegenerate(const TriangleVertices& t) {
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 edge = glm::dvec3(t[(k + 1) % 3]) - glm::dvec3(t[k]);
        longest = std::max(longest, glm::dot(edge, edge));
    }
    const glm::dvec3 normal = doubledNormal(t);
    return 0.25 * glm::dot(normal, normal) <= 1e-30 * longest * longest;
}

constexpr unsigned kRectangleFace[4] = {0, 1, 3, 2};

/// (u, v) of a corner of a cube on one of the faces above, or of a rectangle (face 6), as Mitsuba has them.
glm::vec2 cornerUv(int face, unsigned corner) {
    const auto x = float(corner & 1u), y = float(corner >> 1 & 1u), z = float(corner >> 2 & 1u);
    const glm::vec2 uvs[] = {{y, z}, {y, 1 - z}, {z, x}, {1 - x, 1 - z}, {1 - y, x}, {y, x}, {x, y}};
    return uvs[face];
}

/// World-space shading normal of each vertex; zero where the mesh gives none.
std::vector<glm::vec3> shadingNormals(const PlacedShape& shape) {
    const ShapeDescription& source = *shape.source;
    if (source.mesh.normals.empty() || source.faceNormals || shape.isNull()) return {};
    const glm::dmat3 normalMatrix = glm::transpose(glm::inverse(glm::dmat3(shape.toScene)));
    std::vector<glm::vec3> normals;
    normals.reserve(source.mesh.normals.size());
    for (const glm::dvec3& normal : source.mesh.normals) {
        const glm::dvec3 n = normalMatrix * normal;
        const double length = glm::length(n);
        const double side = source.flipNormals ? -1.0 : 1.0;
        normals.push_back(length > 0.0 && length < 1e300 ? glm::vec3(n * (side / length)) : glm::vec3(0.0f));
    }
    return normals;
}

}  // namespace

double areaOf(const TriangleVertices& triangle) { return 0.5 * glm::length(doubledNormal(triangle)); }

void TriangleSoup::addTriangle(TriangleVertices triangle, TriangleVertices shading, TriangleUvs uv,
                               std::uint32_t shapeIndex) {
    if (isDegenerate(triangle)) {
        ++droppedCount;
        return;
    }
    const bool smooth = std::ranges::all_of(shading, [](const glm::vec3& n) { return n != glm::vec3(0.0f); });
    // Vertex normals say which side is the front, whatever the winding: a mirroring transform turns that, not them.
    if (smooth && glm::dot(doubledNormal(triangle), glm::dvec3(shading[0] + shading[1] + shading[2])) < 0.0) {
        std::swap(triangle[1], triangle[2]);
        std::swap(shading[1], shading[2]);
        std::swap(uv[1], uv[2]);
    }
    vertices.push_back(triangle);
    normals.push_back(smooth ? shading : TriangleVertices{glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f)});
    uvs.push_back(uv);
    shapes.push_back(shapeIndex);
    hasNormals |= smooth;
}

void TriangleSoup::addMesh(const PlacedShape& shape, std::uint32_t shapeIndex) {
    const ShapeDescription& source = *shape.source;
    std::vector<glm::vec3> positions;
    positions.reserve(shape.vertices.size());
    for (const glm::dvec3& vertex : shape.vertices)
        positions.push_back(toFloat(vertex, source.where, nameOf(source) + ": vertices"));
    const std::vector<glm::vec3> smooth = shadingNormals(shape);
    for (const glm::uvec3& index : shape.triangles) {
        TriangleVertices corners, shading{glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f)};
        TriangleUvs uv{glm::vec2(0.0f, 0.0f), glm::vec2(1.0f, 0.0f), glm::vec2(0.0f, 1.0f)};
        for (int k = 0; k < 3; ++k) {
            corners[k] = positions[index[k]];
            if (!smooth.empty()) shading[k] = smooth[index[k]];
            if (!source.mesh.uvs.empty()) uv[k] = glm::vec2(source.mesh.uvs[index[k]]);
        }
        if (source.flipNormals) {
            std::swap(corners[1], corners[2]);
            std::swap(shading[1], shading[2]);
            std::swap(uv[1], uv[2]);
        }
        addTriangle(corners, shading, uv, shapeIndex);
    }
}

void TriangleSoup::addFlat(const PlacedShape& shape, std::uint32_t shapeIndex) {
    const bool isCube = shape.kind == PlacedShape::Kind::Box;
    // Mirrored corners wind clockwise.
    const bool reverse = (shape.source->flipNormals && !shape.isNull()) != shape.mirrored;
    const TriangleVertices flat{glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f)};
    for (int face = 0; face < (isCube ? 6 : 1); ++face) {
        std::array<glm::vec3, 4> corners;
        std::array<glm::vec2, 4> uv;
        for (int k = 0; k < 4; ++k) {
            const unsigned corner = isCube ? kBoxFaces[face][k] : kRectangleFace[k];
            corners[k] = toFloat(shape.vertices[corner], shape.source->where, nameOf(*shape.source) + ": corners");
            uv[k] = cornerUv(isCube ? face : 6, corner);
        }
        if (reverse) {
            std::swap(corners[1], corners[3]);
            std::swap(uv[1], uv[3]);
        }
        addTriangle({corners[0], corners[1], corners[2]}, flat, {uv[0], uv[1], uv[2]}, shapeIndex);
        addTriangle({corners[0], corners[2], corners[3]}, flat, {uv[0], uv[2], uv[3]}, shapeIndex);
    }
}

void TriangleSoup::add(const PlacedShape& shape, std::uint32_t shapeIndex) {
    shape.kind == PlacedShape::Kind::Mesh ? addMesh(shape, shapeIndex) : addFlat(shape, shapeIndex);
}

}  // namespace parhelion
