#include "compile/compile_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "compile/transforms.h"
#include "compile/triangle_soup.h"

namespace parhelion {

namespace {

using Kind = PlacedShape::Kind;

/// The lower, the later to be tessellated: medium boundaries are exact as boxes, and lights are sampled best as quads.
int tessellationRank(const PlacedShape& shape) {
    if (shape.kind == Kind::Box && shape.isNull()) return 0;
    return shape.source->radiance ? 1 : 2;
}

/// Which shapes become triangles.
std::vector<bool> chooseTriangles(std::span<const KeptShape> shapes) {
    std::vector<bool> asTriangles(shapes.size(), true);
    std::vector<std::size_t> order(shapes.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return tessellationRank(*shapes[i].placed); });
    std::size_t quads = 0, boxes = 0;
    for (const std::size_t i : order) {
        const PlacedShape& shape = *shapes[i].placed;
        if (shape.kind == Kind::Sphere) asTriangles[i] = false;
        if (quads + boxes == kMaxFlatPrimitives) continue;
        if (shape.kind == Kind::Quad && quads < shared::kMaxQuads) {
            asTriangles[i] = false;
            ++quads;
        }
        // Cubes have no light sampling of their own: emissive ones are mesh lights.
        if (shape.kind == Kind::Box && boxes < shared::kMaxBoxes && !shape.source->radiance) {
            asTriangles[i] = false;
            ++boxes;
        }
    }
    return asTriangles;
}

/// Mitsuba's spheres turn inside out under a mirroring transform, cubes do not; medium boundaries have no such side.
/// Quads and triangles have their side in the data.
std::uint32_t shapeFlags(const PlacedShape& shape, bool asTriangles) {
    if (shape.isNull()) return shared::kShapeNull;
    const bool turned = shape.kind == PlacedShape::Kind::Sphere && shape.mirrored;
    const bool flips = shape.isAnalyticSolid() && !asTriangles && shape.source->flipNormals != turned;
    return (shape.source->bsdf.twoSided ? shared::kShapeTwoSided : 0u) | (flips ? shared::kShapeFlipNormal : 0u);
}

shared::Shape makeShape(const KeptShape& kept, bool asTriangles) {
    const ShapeDescription& source = *kept.placed->source;
    shared::Shape record{};
    if (!kept.placed->isNull())
        record.reflectance = toFloat(source.bsdf.reflectance * kept.reflectance.tint, source.bsdf.where,
                                     nameOf(source) + ": reflectance");
    record.flags = shapeFlags(*kept.placed, asTriangles);
    record.interior = kept.interior;
    record.exterior = kept.exterior;
    record.light = shared::kNone;
    record.texture = kept.reflectance.index;
    return record;
}

/// The corner is float; edges are differences of doubles, so a far quad keeps its shape.
shared::Quad makeQuad(const PlacedShape& shape, std::uint32_t index) {
    const SourceLocation& where = shape.source->where;
    const std::string name = nameOf(*shape.source);
    const glm::dvec3 u = 2.0 * glm::dvec3(shape.toScene[0]), v = 2.0 * glm::dvec3(shape.toScene[1]);
    const glm::dvec3 n = glm::cross(u, v);
    const double area = glm::length(n);
    shared::Quad quad{};
    quad.corner = toFloat(shape.vertices[0], where, name + ": corner");
    quad.edgeU = toFloat(u, where, name + ": edge");
    quad.edgeV = toFloat(v, where, name + ": edge");
    quad.area = toFloat(glm::dvec3(area), where, name + ": area").x;
    quad.normal = glm::vec3(n / (shape.source->flipNormals != shape.mirrored ? -area : area));
    quad.uFromWorld = toFloat(glm::cross(v, n) / (area * area), where, name + ": inverse edge");
    quad.vFromWorld = toFloat(glm::cross(n, u) / (area * area), where, name + ": inverse edge");
    quad.shape = index;
    return quad;
}

shared::Sphere makeSphere(const PlacedShape& shape, std::uint32_t index, std::uint32_t flags) {
    shared::Sphere sphere{};
    sphere.center = toFloat(shape.center, shape.source->where, nameOf(*shape.source) + ": center");
    sphere.radius = toFloat(glm::dvec3(shape.radius), shape.source->where, nameOf(*shape.source) + ": radius").x;
    sphere.shape = index;
    sphere.flags = flags;
    sphere.axisX = glm::vec3(glm::normalize(glm::dvec3(shape.toScene[0])));
    sphere.axisZ = glm::vec3(glm::normalize(glm::dvec3(shape.toScene[2])));
    sphere.handedness = shape.mirrored ? -1.0f : 1.0f;
    return sphere;
}

shared::Box makeBox(const PlacedShape& shape, std::uint32_t index, std::uint32_t flags) {
    shared::Box box{};
    box.localFromWorld =
        toFloat(glm::inverse(shape.toScene), shape.source->where, nameOf(*shape.source) + ": inverse of to_world");
    box.shape = index;
    box.flags = flags;
    return box;
}

void writeTriangles(const TriangleSoup& soup, Bvh bvh, std::span<const KeptShape> shapes, CompiledScene& scene) {
    scene.constants.triangleCount = std::uint32_t(bvh.order.size());
    scene.bvhNodes = std::move(bvh.nodes);
    scene.triangles.reserve(shared::kTriangleTexels * bvh.order.size());
    for (const std::uint32_t i : bvh.order)
        for (int k = 0; k < 3; ++k)
            scene.triangles.emplace_back(soup.vertices[i][k], k == 0 ? std::bit_cast<float>(soup.shapes[i]) : 0.0f);
    for (const std::uint32_t i : bvh.order)
        for (int k = 0; k < 3 && soup.hasNormals; ++k) scene.vertexNormals.emplace_back(soup.normals[i][k], 0.0f);
    if (std::ranges::none_of(shapes, &KeptShape::isTextured)) return;
    for (const std::uint32_t i : bvh.order)
        scene.triangleUvs.insert(scene.triangleUvs.end(), soup.uvs[i].begin(), soup.uvs[i].end());
}

void checkTriangleCount(const TriangleSoup& soup) {
    constexpr std::size_t kMaxTriangles = kMaxTexels / shared::kBvhNodeTexels;
    if (soup.vertices.size() > kMaxTriangles)
        throw RuntimeFailure(
            fmt::format("the scene may have at most {} triangles; got {}", kMaxTriangles, soup.vertices.size()));
}

void appendAnalytic(const PlacedShape& shape, std::uint32_t index, CompiledScene& scene) {
    shared::SceneConstants& constants = scene.constants;
    const std::uint32_t flags = scene.shapes[index].flags;
    if (shape.kind == Kind::Quad) constants.quads[constants.quadCount++] = makeQuad(shape, index);
    if (shape.kind == Kind::Box) constants.boxes[constants.boxCount++] = makeBox(shape, index, flags);
    if (shape.kind != Kind::Sphere) return;
    if (constants.sphereCount == shared::kMaxSpheres)
        throw InputError(shape.source->where,
                         fmt::format("a scene may have at most {} spheres; use meshes for more", shared::kMaxSpheres));
    constants.spheres[constants.sphereCount++] = makeSphere(shape, index, flags);
}

}  // namespace

std::vector<EmissiveGeometry> compileGeometry(std::span<const KeptShape> shapes, CompiledScene& scene) {
    std::vector<EmissiveGeometry> emissive(shapes.size());
    const std::vector<bool> asTriangles = chooseTriangles(shapes);
    TriangleSoup soup;
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
        scene.shapes.push_back(makeShape(shapes[i], asTriangles[i]));
        asTriangles[i] ? soup.add(*shapes[i].placed, i) : appendAnalytic(*shapes[i].placed, i, scene);
    }
    checkTriangleCount(soup);
    if (soup.droppedCount > 0)
        scene.notes.push_back(fmt::format("{} triangles of zero area were dropped", soup.droppedCount));
    writeTriangles(soup, buildBvh(soup.vertices), shapes, scene);

    const shared::SceneConstants& constants = scene.constants;
    for (std::uint32_t i = 0; i < constants.quadCount; ++i) emissive[constants.quads[i].shape].primitive = i;
    for (std::uint32_t i = 0; i < constants.sphereCount; ++i)
        emissive[constants.spheres[i].shape].primitive = constants.quadCount + i;
    const std::uint32_t firstTriangle = constants.quadCount + constants.sphereCount + constants.boxCount;
    for (std::uint32_t i = 0; i < constants.triangleCount; ++i) {
        const auto shape = std::bit_cast<std::uint32_t>(scene.triangles[shared::kTriangleTexels * i].w);
        if (shapes[shape].placed->source->radiance) emissive[shape].triangles.push_back(firstTriangle + i);
    }
    return emissive;
}

}  // namespace parhelion
