#include "support/hand_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "compile/bvh_builder.h"
#include "compile/compile_environment.h"
#include "compile/compile_lights.h"
#include "compile/compile_sky.h"
#include "compile/distribution_table.h"
#include "reference/reference_renderer.h"

namespace parhelion::test {
namespace {

using shared::kNone;

/// World -> voxel units for a grid over [low, high].
glm::mat4x3 gridFromWorld(glm::vec3 low, glm::vec3 high, glm::vec3 resolution) {
    const glm::vec3 scale = resolution / (high - low);
    return {{scale.x, 0, 0}, {0, scale.y, 0}, {0, 0, scale.z}, -low * scale};
}

glm::vec3 anyPerpendicular(glm::vec3 v) {
    const glm::vec3 axis = std::abs(v.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    return glm::normalize(glm::cross(v, axis));
}

}  // namespace

HandScene::HandScene() {
    scene.constants.emitterSamples = scene.constants.scatterSamples = 1.0f;
    scene.constants.environment = kNone;
    scene.constants.maxDepth = kNone;
    scene.constants.rouletteDepth = kNone;
    lookAlong({0, 0, -1});
}

void HandScene::lookAlong(glm::vec3 direction, std::uint32_t inside) {
    scene.constants.camera = {direction, inside, glm::vec3(0), 0, glm::vec3(0), 0, glm::uvec2(0), glm::uvec2(1)};
    scene.filmSize = scene.cropSize = {1, 1};
}

void HandScene::lookAt(glm::vec3 direction, glm::uvec2 size) {
    const glm::vec3 forward = glm::normalize(direction);
    const glm::vec3 dx = anyPerpendicular(forward) * (2.0f / float(size.x));
    const glm::vec3 dy = glm::cross(forward, dx);
    shared::Camera& camera = scene.constants.camera;
    camera.forward = forward - dx * (0.5f * float(size.x)) - dy * (0.5f * float(size.y));
    camera.dx = dx;
    camera.dy = dy;
    scene.filmSize = scene.cropSize = size;
}

std::uint32_t HandScene::addHomogeneous(float sigma, glm::vec3 albedo, float g, glm::vec3 sigmaRatio) {
    shared::Medium& m = scene.constants.media[scene.constants.mediumCount];
    m.sigmaMax = sigma;
    m.sigmaRatio = sigmaRatio;
    m.albedo = albedo;
    m.g = g;
    m.phase = g == 0 ? shared::kPhaseIsotropic : shared::kPhaseHenyeyGreenstein;
    m.flags = shared::kMediumHomogeneous;
    return scene.constants.mediumCount++;
}

std::uint32_t HandScene::addGrid(float sigma, glm::vec3 albedo, glm::uvec3 resolution, std::span<const float> voxels,
                                 glm::vec3 low, glm::vec3 high, float slack) {
    const std::uint32_t index = addHomogeneous(sigma, albedo);
    shared::Medium& m = scene.constants.media[index];
    m.flags = 0;
    m.gridFromWorld = gridFromWorld(low, high, resolution);
    m.resolution = resolution;
    m.cells = (resolution + 7u) / 8u;
    m.voxelOffset = std::uint32_t(scene.density.size());
    m.cellOffset = std::uint32_t(scene.majorants.size());
    scene.density.insert(scene.density.end(), voxels.begin(), voxels.end());
    const float bound = *std::max_element(voxels.begin(), voxels.end()) * slack;
    scene.majorants.resize(scene.majorants.size() + std::size_t(m.cells.x) * m.cells.y * m.cells.z, bound);
    return index;
}

std::uint32_t HandScene::addShape(const shared::Shape& shape) {
    scene.shapes.push_back(shape);
    return std::uint32_t(scene.shapes.size() - 1);
}

std::uint32_t HandScene::addNull(std::uint32_t interior, std::uint32_t exterior) {
    return addShape({glm::vec3(0), shared::kShapeNull, interior, exterior, kNone, kNone});
}

std::uint32_t HandScene::addDiffuse(glm::vec3 reflectance, std::uint32_t flags) {
    return addShape({reflectance, flags, kNone, kNone, kNone, kNone});
}

std::uint32_t HandScene::addQuad(glm::vec3 corner, glm::vec3 edgeU, glm::vec3 edgeV, std::uint32_t shape) {
    const glm::dvec3 u(edgeU), v(edgeV), n = glm::cross(u, v);
    const double n2 = glm::dot(n, n);
    shared::Quad& quad = scene.constants.quads[scene.constants.quadCount];
    quad.corner = corner;
    quad.shape = shape;
    quad.edgeU = edgeU;
    quad.edgeV = edgeV;
    quad.area = float(std::sqrt(n2));
    quad.normal = n / std::sqrt(n2);
    quad.uFromWorld = glm::cross(v, n) / n2;
    quad.vFromWorld = glm::cross(n, u) / n2;
    return scene.constants.quadCount++;
}

std::uint32_t HandScene::addSphere(glm::vec3 center, float radius, std::uint32_t shape) {
    shared::Sphere& sphere = scene.constants.spheres[scene.constants.sphereCount] = {};
    sphere.center = center;
    sphere.radius = radius;
    sphere.shape = shape;
    sphere.flags = scene.shapes[shape].flags;
    sphere.axisX = {1, 0, 0};
    sphere.axisZ = {0, 0, 1};
    sphere.handedness = 1;
    return scene.constants.quadCount + scene.constants.sphereCount++;
}

std::uint32_t HandScene::addBox(glm::vec3 low, glm::vec3 high, std::uint32_t shape) {
    shared::Box& box = scene.constants.boxes[scene.constants.boxCount];
    // [-1, 1]^3: the grid mapping of two voxels, moved to the middle.
    box.localFromWorld = gridFromWorld(low, high, glm::vec3(2));
    box.localFromWorld[3] -= glm::vec3(1);
    box.shape = shape;
    box.flags = scene.shapes[shape].flags;
    return scene.constants.quadCount + scene.constants.sphereCount + scene.constants.boxCount++;
}

void HandScene::addTriangles(std::span<const glm::vec3> vertices, std::uint32_t shape) {
    std::vector<TriangleVertices> triangles;
    for (std::size_t i = 0; i < vertices.size(); i += 3)
        triangles.push_back({vertices[i], vertices[i + 1], vertices[i + 2]});
    const Bvh bvh = buildBvh(triangles);
    scene.bvhNodes = bvh.nodes;
    for (const std::uint32_t triangle : bvh.order) {
        const TriangleVertices& v = triangles[triangle];
        scene.triangles.emplace_back(v[0], glm::uintBitsToFloat(shape));
        scene.triangles.emplace_back(v[1], 0.0f);
        scene.triangles.emplace_back(v[2], 0.0f);
    }
    scene.constants.triangleCount = std::uint32_t(triangles.size());
}

void HandScene::setEnvironment(glm::vec3 radiance) {
    scene.constants.environment = scene.constants.lightCount;
    shared::Light light{};
    light.type = shared::kLightEnvironment;
    light.emission = radiance;
    addLight(light, false);
}

void HandScene::setSky(const SkyDescription& sky, bool isSampled) {
    shared::Light light{};
    light.type = shared::kLightSky;
    light.emission = compileSky(sky, {}, scene);
    scene.constants.environment = scene.constants.lightCount;
    addLight(light, isSampled);
}

void HandScene::setEnvironmentMap(const EmitterDescription& map, bool isSampled) {
    shared::Light light{};
    light.type = shared::kLightEnvironmentMap;
    light.emission = compileEnvironment(map, map.misCompensation, scene);
    scene.constants.environment = scene.constants.lightCount;
    addLight(light, isSampled);
}

void HandScene::addLight(shared::Light light, bool isSampled) {
    light.texture = kNone;
    scene.constants.lights[scene.constants.lightCount++] = light;
    sampled_.push_back(isSampled);
    const std::vector<double> powers(sampled_.begin(), sampled_.end());
    assignSelection(powers, std::span(scene.constants.lights).first(powers.size()));
}

void HandScene::addAreaLight(std::uint32_t type, std::uint32_t primitive, std::uint32_t shape, glm::vec3 radiance,
                             bool isSampled) {
    scene.shapes[shape].light = scene.constants.lightCount;
    shared::Light light{};
    light.type = type;
    light.primitive = primitive;
    light.emission = radiance;
    addLight(light, isSampled);
}

void HandScene::addMeshLight(std::uint32_t shape, glm::vec3 radiance, bool isSampled) {
    shared::Light light{};
    light.triangleCount = scene.constants.triangleCount;
    light.triangleOffset = std::uint32_t(scene.lightTriangles.size());
    light.distribution = std::uint32_t(scene.distributions.size());
    std::vector<double> areas;
    for (std::uint32_t i = 0; i < light.triangleCount; ++i) {
        const glm::dvec3 v0(scene.triangles[3 * i]), v1(scene.triangles[3 * i + 1]), v2(scene.triangles[3 * i + 2]);
        areas.push_back(0.5 * glm::length(glm::cross(v1 - v0, v2 - v0)));
        scene.lightTriangles.push_back(scene.constants.quadCount + scene.constants.sphereCount +
                                       scene.constants.boxCount + i);
    }
    const DistributionTable table = buildDistribution(areas);
    scene.distributions.insert(scene.distributions.end(), table.texels.begin(), table.texels.end());
    for (std::size_t i = 0; i < areas.size(); ++i)
        scene.triangleAreas.push_back(float(areas[i] / table.probabilities[i]));
    scene.shapes[shape].light = scene.constants.lightCount;
    light.type = shared::kLightMesh;
    light.primitive = scene.lightTriangles[light.triangleOffset];
    light.emission = radiance;
    addLight(light, isSampled);
}

HandScene floorPatch(glm::vec3 reflectance, float distance) {
    HandScene scene;
    scene.lookAlong({0, 0, -1});
    scene.addQuad({-0.1f, -0.1f, -distance}, {0.2f, 0, 0}, {0, 0.2f, 0}, scene.addDiffuse(reflectance));
    return scene;
}

HandScene fogBox(glm::vec3 albedo) {
    HandScene scene;
    scene.lookAlong({0.1f, 0.2f, -1});
    scene.addBox({-2, -2, -4}, {2, 2, -2}, scene.addNull(scene.addHomogeneous(1, albedo, 0.6f)));
    return scene;
}

PixelEstimate estimate(const shared::FilmPixel& pixel, std::uint64_t samples, int channel) {
    const double n = double(samples);
    const double mean = (double(pixel.sumHigh[channel]) + pixel.sumLow[channel]) / n;
    const double square = (double(pixel.squareHigh[channel]) + pixel.squareLow[channel]) / n;
    return {mean, std::sqrt(std::max(0.0, square - mean * mean) / n)};
}

PixelEstimate renderPixel(const CompiledScene& scene, std::uint64_t samples, bool inDouble, int channel) {
    RenderSettings settings;
    settings.sampleCount = samples;
    settings.featureSamples = 0;
    const Film film = inDouble ? reference::render<double>(scene, settings) : reference::render<float>(scene, settings);
    return estimate(film.pixels.at(0), film.samples, channel);
}

std::vector<glm::vec3> icosphere(int subdivisions) {
    const float phi = (1 + std::sqrt(5.0f)) / 2;
    const std::array<glm::vec3, 12> v{{{-1, phi, 0},
                                       {1, phi, 0},
                                       {-1, -phi, 0},
                                       {1, -phi, 0},
                                       {0, -1, phi},
                                       {0, 1, phi},
                                       {0, -1, -phi},
                                       {0, 1, -phi},
                                       {phi, 0, -1},
                                       {phi, 0, 1},
                                       {-phi, 0, -1},
                                       {-phi, 0, 1}}};
    constexpr std::array<int, 60> kFaces{0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                                         4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                                         6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    std::vector<glm::vec3> vertices;
    for (const int i : kFaces) vertices.push_back(glm::normalize(v[i]));
    for (int level = 0; level < subdivisions; ++level) {
        std::vector<glm::vec3> finer;
        for (std::size_t i = 0; i < vertices.size(); i += 3) {
            const glm::vec3 a = vertices[i], b = vertices[i + 1], c = vertices[i + 2];
            const glm::vec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
            for (const glm::vec3 p : {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca}) finer.push_back(p);
        }
        vertices = std::move(finer);
    }
    return vertices;
}

}  // namespace parhelion::test
