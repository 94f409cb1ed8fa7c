#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>

#include "gpu/pipeline.h"
#include "gpu/spirv_interface.h"
#include "shared/cloud_types.h"
#include "shared/path_types.h"
#include "shared/scene_types.h"
#include "support/temporary_folder.h"

namespace parhelion {
namespace {

using Members = std::vector<gpu::SpirvInterface::Member>;

/// A shader that stores the struct, followed by a word: the word's offset is the struct's size.
std::string shaderStoring(const std::string& type) {
    return "#version 460\n"
           "#extension GL_EXT_scalar_block_layout : require\n"
           "#include \"shared/scene_types.h\"\n"
           "#include \"shared/path_types.h\"\n"
           "#include \"shared/cloud_types.h\"\n"
           "layout(local_size_x = 1) in;\n"
           "struct Followed { " +
           type +
           " value; uint size; };\n"
           "layout(set = 0, binding = 0, scalar) buffer Block { Followed followed; };\n"
           "void main() { followed.size = 0u; }\n";
}

/// Padding is left out: the offsets around it and the struct's size tell.
std::string textOf(const Members& members) {
    std::string text;
    for (const auto& member : members)
        if (!member.name.starts_with("reserved")) text += member.name + " at " + std::to_string(member.offset) + "\n";
    return text;
}

/// Every member by name, order and offset, and the size: what a shader reads is what the host wrote.
void expectLayout(const std::string& type, std::size_t size, const Members& expected) {
    const test::TemporaryFolder folder;
    const auto spirv = gpu::compileShader(folder.write(type + ".comp", shaderStoring(type)));
    const gpu::SpirvInterface interface = gpu::reflect(spirv);
    ASSERT_TRUE(interface.structs.contains(type));
    EXPECT_EQ(textOf(interface.structs.at(type)), textOf(expected)) << "struct " << type;
    ASSERT_TRUE(interface.structs.contains("Followed"));
    EXPECT_EQ(textOf(interface.structs.at("Followed")), textOf({{"value", 0}, {"size", std::uint32_t(size)}}));
}

#define MEMBER(name) \
    { #name, static_cast < std::uint32_t>(offsetof(Type, name)) }

TEST(SharedLayout, FilmPixelIsTheSameInBothLanguages) {
    using Type = shared::FilmPixel;
    expectLayout("FilmPixel", sizeof(Type),
                 {MEMBER(sumHigh), MEMBER(sumLow), MEMBER(squareHigh), MEMBER(squareLow), MEMBER(powerHigh),
                  MEMBER(powerLow), MEMBER(third), MEMBER(fourth), MEMBER(pivot), MEMBER(largest)});
}

TEST(SharedLayout, LayerPixelIsTheSameInBothLanguages) {
    using Type = shared::LayerPixel;
    expectLayout("LayerPixel", sizeof(Type), {MEMBER(sumHigh), MEMBER(sumLow)});
}

TEST(SharedLayout, FeaturePixelIsTheSameInBothLanguages) {
    using Type = shared::FeaturePixel;
    expectLayout("FeaturePixel", sizeof(Type), {MEMBER(albedo), MEMBER(depth), MEMBER(normal), MEMBER(hits)});
}

TEST(SharedLayout, PathArgumentsAreTheSameInBothLanguages) {
    using Type = shared::PathArguments;
    expectLayout("PathArguments", sizeof(Type),
                 {MEMBER(filmSize), MEMBER(cropOffset), MEMBER(cropSize), MEMBER(firstPixel), MEMBER(laneCount),
                  MEMBER(sampleLow), MEMBER(sampleHigh), MEMBER(sampleCount), MEMBER(seed), MEMBER(loopBudget),
                  MEMBER(restart), MEMBER(pauseAt), MEMBER(stallLimit), MEMBER(imageLanes), MEMBER(emptyFilm)});
}

TEST(SharedLayout, ShapeIsTheSameInBothLanguages) {
    using Type = shared::Shape;
    expectLayout(
        "Shape", sizeof(Type),
        {MEMBER(reflectance), MEMBER(flags), MEMBER(interior), MEMBER(exterior), MEMBER(light), MEMBER(texture)});
}

TEST(SharedLayout, QuadIsTheSameInBothLanguages) {
    using Type = shared::Quad;
    expectLayout("Quad", sizeof(Type),
                 {MEMBER(corner), MEMBER(shape), MEMBER(edgeU), MEMBER(area), MEMBER(edgeV), MEMBER(normal),
                  MEMBER(uFromWorld), MEMBER(vFromWorld)});
}

TEST(SharedLayout, SphereIsTheSameInBothLanguages) {
    using Type = shared::Sphere;
    expectLayout("Sphere", sizeof(Type),
                 {MEMBER(center), MEMBER(radius), MEMBER(shape), MEMBER(flags), MEMBER(axisX), MEMBER(axisZ),
                  MEMBER(handedness)});
}

TEST(SharedLayout, BoxIsTheSameInBothLanguages) {
    using Type = shared::Box;
    expectLayout("Box", sizeof(Type), {MEMBER(localFromWorld), MEMBER(shape), MEMBER(flags)});
}

TEST(SharedLayout, MediumIsTheSameInBothLanguages) {
    using Type = shared::Medium;
    expectLayout("Medium", sizeof(Type), {MEMBER(gridFromWorld),
                                          MEMBER(sigmaRatio),
                                          MEMBER(sigmaMax),
                                          MEMBER(albedo),
                                          MEMBER(g),
                                          MEMBER(resolution),
                                          MEMBER(voxelOffset),
                                          MEMBER(cells),
                                          MEMBER(cellOffset),
                                          MEMBER(albedoFromWorld),
                                          MEMBER(albedoResolution),
                                          MEMBER(albedoOffset),
                                          MEMBER(phase),
                                          MEMBER(flags),
                                          MEMBER(g2),
                                          MEMBER(lobeWeight),
                                          MEMBER(phaseOffset),
                                          MEMBER(phaseCount),
                                          MEMBER(cellLevel),
                                          MEMBER(phaseDistribution)});
}

TEST(SharedLayout, LightIsTheSameInBothLanguages) {
    using Type = shared::Light;
    expectLayout("Light", sizeof(Type),
                 {MEMBER(emission), MEMBER(type), MEMBER(vector), MEMBER(primitive), MEMBER(selection),
                  MEMBER(cumulative), MEMBER(reciprocal), MEMBER(triangleCount), MEMBER(triangleOffset),
                  MEMBER(texture), MEMBER(flags), MEMBER(distribution)});
}

TEST(SharedLayout, TextureIsTheSameInBothLanguages) {
    using Type = shared::Texture;
    expectLayout("Texture", sizeof(Type),
                 {MEMBER(transformU), MEMBER(transformV), MEMBER(translation), MEMBER(flags), MEMBER(offset),
                  MEMBER(size), MEMBER(color0), MEMBER(color1)});
}

TEST(SharedLayout, EnvironmentMapIsTheSameInBothLanguages) {
    using Type = shared::EnvironmentMap;
    expectLayout("EnvironmentMap", sizeof(Type),
                 {MEMBER(localX), MEMBER(width), MEMBER(localY), MEMBER(height), MEMBER(localZ), MEMBER(distribution)});
}

TEST(SharedLayout, SkyIsTheSameInBothLanguages) {
    using Type = shared::Sky;
    expectLayout("Sky", sizeof(Type),
                 {MEMBER(axis), MEMBER(offset), MEMBER(bottom), MEMBER(width), MEMBER(top), MEMBER(power),
                  MEMBER(starRadiance), MEMBER(starCells), MEMBER(starCount), MEMBER(bandCount), MEMBER(distribution)});
}

TEST(SharedLayout, CloudFieldIsTheSameInBothLanguages) {
    using Type = shared::CloudField;
    expectLayout(
        "CloudField", sizeof(Type),
        {MEMBER(detailAmount), MEMBER(noiseScale), MEMBER(warpAmount), MEMBER(erosionAmount), MEMBER(surfaceWidth),
         MEMBER(densityScale), MEMBER(densityThreshold), MEMBER(noiseSeed), MEMBER(resolution), MEMBER(modulates)});
}

TEST(SharedLayout, CloudArgumentsAreTheSameInBothLanguages) {
    using Type = shared::CloudArguments;
    expectLayout("CloudArguments", sizeof(Type),
                 {MEMBER(frequency), MEMBER(blend), MEMBER(voxelSize), MEMBER(sharpness), MEMBER(detailAmount),
                  MEMBER(warpAmount), MEMBER(erosionAmount), MEMBER(densityScale), MEMBER(densityThreshold),
                  MEMBER(inverseLargest), MEMBER(noiseSeed), MEMBER(modulates), MEMBER(resolution), MEMBER(firstVoxel),
                  MEMBER(voxelCount)});
}

TEST(SharedLayout, CameraIsTheSameInBothLanguages) {
    using Type = shared::Camera;
    expectLayout("Camera", sizeof(Type),
                 {MEMBER(forward), MEMBER(inside), MEMBER(dx), MEMBER(filterEdges), MEMBER(dy), MEMBER(hasFilter),
                  MEMBER(filmLower), MEMBER(filmUpper)});
}

TEST(SharedLayout, SceneConstantsAreTheSameInBothLanguages) {
    using Type = shared::SceneConstants;
    expectLayout("SceneConstants", sizeof(Type),
                 {MEMBER(camera),
                  MEMBER(quadCount),
                  MEMBER(sphereCount),
                  MEMBER(boxCount),
                  MEMBER(triangleCount),
                  MEMBER(mediumCount),
                  MEMBER(lightCount),
                  MEMBER(environment),
                  MEMBER(maxDepth),
                  MEMBER(rouletteDepth),
                  MEMBER(environmentRadiance),
                  MEMBER(emitterSamples),
                  MEMBER(scatterSamples),
                  MEMBER(depthLayers),
                  MEMBER(environmentMap),
                  MEMBER(sky),
                  MEMBER(quads),
                  MEMBER(spheres),
                  MEMBER(boxes),
                  MEMBER(media),
                  MEMBER(lights),
                  MEMBER(shapes)});
}

#undef MEMBER

/// A struct added to shaders/shared must be added above.
TEST(SharedLayout, EveryStructIsCompared) {
    constexpr int kCompared = 17;
    int declared = 0;
    for (const auto& entry : std::filesystem::directory_iterator(gpu::shaderFolder() / "shared")) {
        std::ifstream lines(entry.path());
        for (std::string line; std::getline(lines, line);) declared += line.starts_with("struct ");
    }
    EXPECT_EQ(declared, kCompared);
}

}  // namespace
}  // namespace parhelion
