#include "compile/compiled_scene.h"

#include <numeric>

namespace parhelion {

namespace {

template <typename T>
std::size_t bytesOf(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

}  // namespace

EffectSet EffectSet::all() {
    EffectSet effects;
    effects.on.set();
    effects.reasons.fill("yes: every effect was asked for");
    return effects;
}

std::vector<ArraySize> CompiledScene::arraySizes() const {
    return {{"constants", sizeof(constants)},
            {"shapes", bytesOf(shapes)},
            {"bvhNodes", bytesOf(bvhNodes)},
            {"triangles", bytesOf(triangles)},
            {"vertexNormals", bytesOf(vertexNormals)},
            {"density", bytesOf(density)},
            {"brickTable", bytesOf(brickTable)},
            {"majorants", bytesOf(majorants)},
            {"albedoVoxels", bytesOf(albedoVoxels)},
            {"triangleAreas", bytesOf(triangleAreas)},
            {"lightTriangles", bytesOf(lightTriangles)},
            {"filterTable", bytesOf(filterTable)},
            {"textures", bytesOf(textures)},
            {"textureTexels", bytesOf(textureTexels)},
            {"triangleUvs", bytesOf(triangleUvs)},
            {"phaseTable", bytesOf(phaseTable)},
            {"environmentTexels", bytesOf(environmentTexels)},
            {"distributions", bytesOf(distributions)},
            {"environmentRows", bytesOf(environmentRows)},
            {"skyBands", bytesOf(skyBands)},
            {"stars", bytesOf(stars)},
            {"starCells", bytesOf(starCells)}};
}

std::size_t CompiledScene::memoryBytes() const {
    const std::vector<ArraySize> sizes = arraySizes();
    return std::accumulate(sizes.begin(), sizes.end(), std::size_t(0),
                           [](std::size_t sum, const ArraySize& array) { return sum + array.bytes; });
}

}  // namespace parhelion
