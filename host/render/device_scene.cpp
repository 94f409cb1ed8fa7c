#include "render/device_scene.h"

#include <algorithm>
#include <cstring>

#include "compile/boundary_order.h"

namespace parhelion::render {
namespace {

/// Adds the numbers of boundaries to all copies of their flags.
void addOrder(std::span<const std::uint32_t> order, shared::SceneConstants& constants) {
    for (std::uint32_t i = 0; i < constants.sphereCount; ++i)
        constants.spheres[i].flags |= order[constants.spheres[i].shape];
    for (std::uint32_t i = 0; i < constants.boxCount; ++i) constants.boxes[i].flags |= order[constants.boxes[i].shape];
    const std::size_t inlined = std::min<std::size_t>(order.size(), shared::kMaxInlineShapes);
    for (std::size_t i = 0; i < inlined; ++i) constants.shapes[i].flags |= order[i];
}

}  // namespace

template <typename T>
void DeviceScene::addTexels(gpu::Device& device, std::uint32_t binding, const std::vector<T>& values, VkFormat format) {
    // A binding that the scene leaves empty still needs a texel to point at.
    gpu::Buffer buffer = device.createBuffer(std::max<std::size_t>(values.size() * sizeof(T), 16));
    buffer.write(0, std::as_bytes(std::span(values)));
    const VkBufferView view = buffer.texelView(format);
    bindings_.push_back({.index = binding, .view = view});
    buffers_.push_back(std::move(buffer));
}

DeviceScene::DeviceScene(gpu::Device& device, const CompiledScene& scene) {
    gpu::Buffer constants = device.createBuffer(sizeof(shared::SceneConstants));
    std::memcpy(constants.data(), &scene.constants, sizeof(shared::SceneConstants));
    const std::vector<std::uint32_t> order = orderBoundaries(scene);
    std::vector<shared::Shape> shapes = scene.shapes;
    for (std::size_t i = 0; i < shapes.size(); ++i) shapes[i].flags |= order[i];
    addOrder(order, *static_cast<shared::SceneConstants*>(constants.data()));
    bindings_.push_back({.index = 0, .buffer = constants.handle()});
    buffers_.push_back(std::move(constants));

    const VkFormat rgba = VK_FORMAT_R32G32B32A32_SFLOAT, r = VK_FORMAT_R32_SFLOAT, u = VK_FORMAT_R32_UINT;
    addTexels(device, 1, shapes, rgba);
    addTexels(device, 2, scene.bvhNodes, rgba);
    addTexels(device, 3, scene.triangles, rgba);
    addTexels(device, 4, scene.vertexNormals, rgba);
    addTexels(device, 5, scene.density, r);
    addTexels(device, 6, scene.brickTable, u);
    addTexels(device, 7, scene.majorants, r);
    addTexels(device, 8, scene.albedoVoxels, rgba);
    addTexels(device, 9, scene.triangleAreas, r);
    addTexels(device, 10, scene.lightTriangles, u);
    addTexels(device, 11, scene.filterTable, r);

    const VkFormat rg = VK_FORMAT_R32G32_SFLOAT, uu = VK_FORMAT_R32G32_UINT;
    addTexels(device, 16, scene.textures, rgba);
    addTexels(device, 17, scene.textureTexels, rgba);
    addTexels(device, 18, scene.triangleUvs, rg);
    addTexels(device, 19, scene.phaseTable, r);
    addTexels(device, 20, scene.environmentTexels, rgba);
    addTexels(device, 21, scene.distributions, uu);
    addTexels(device, 22, scene.environmentRows, rg);
    addTexels(device, 23, scene.skyBands, r);
    addTexels(device, 24, scene.stars, rgba);
    addTexels(device, 25, scene.starCells, u);
    addTexels(device, 27, std::vector<std::uint32_t>{0}, u);
}

}  // namespace parhelion::render
