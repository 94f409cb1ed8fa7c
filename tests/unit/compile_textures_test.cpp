#include "compile/compile_textures.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "unit/compile_fixtures.h"

namespace parhelion {
namespace {

using namespace fixtures;

TextureDescription checkers(const glm::dvec3& color0, const glm::dvec3& color1) {
    TextureDescription texture;
    texture.type = TextureDescription::Type::Checkerboard;
    texture.color0 = color0;
    texture.color1 = color1;
    return texture;
}

TextureDescription bitmap(glm::uvec2 size, std::vector<glm::vec3> texels) {
    TextureDescription texture;
    texture.bitmap = {size, std::move(texels)};
    return texture;
}

/// Shapes that all reflect by texture 0, tinted.
SceneDescription textured(std::vector<ShapeDescription> shapes, const TextureDescription& texture,
                          const glm::dvec3& tint = glm::dvec3(1)) {
    SceneDescription description = scene();
    description.textures.push_back(texture);
    for (ShapeDescription& shape : shapes) {
        shape.bsdf.texture = 0;
        shape.bsdf.reflectance = tint;
    }
    description.shapes = std::move(shapes);
    return description;
}

TEST(CompileTextures, OneColourBecomesTheReflectance) {
    const glm::dvec3 tint(0.5, 1, 0.25);
    for (const TextureDescription& texture :
         {checkers({0.5, 0.25, 1}, {0.5, 0.25, 1}), bitmap({1, 1}, {{0.5f, 0.25f, 1}}),
          bitmap({2, 1}, {{0.5f, 0.25f, 1}, {0.5f, 0.25f, 1}})}) {
        const CompiledScene scene = compileScene(textured({rectangle("r")}, texture, tint), {});
        EXPECT_TRUE(scene.textures.empty());
        EXPECT_EQ(scene.shapes.at(0).texture, shared::kNone);
        EXPECT_EQ(scene.shapes.at(0).reflectance, glm::vec3(0.25f, 0.25f, 0.25f));
        EXPECT_FALSE(scene.effects.has(Effect::hasTextures));
    }
}

TEST(CompileTextures, AreSharedAndTinted) {
    const auto description =
        textured({rectangle("a"), sphere("b", {}, 1)}, checkers({0, 0, 0}, {1, 1, 1}), {0.5, 1, 0.25});
    const CompiledScene scene = compileScene(description, {});
    EXPECT_EQ(scene.textures.size(), 1u);
    for (const shared::Shape& shape : scene.shapes) {
        EXPECT_EQ(shape.texture, 0u);
        EXPECT_EQ(shape.reflectance, glm::vec3(0.5f, 1, 0.25f));
    }
    EXPECT_TRUE(scene.effects.has(Effect::hasTextures));
    EXPECT_FALSE(scene.effects.has(Effect::hasTexturedLights));
    EXPECT_NE(scene.effects.reasons[unsigned(Effect::hasTextures)].find("2 textured shapes"), std::string::npos);
}

TEST(CompileTextures, UnusedOnesAreLeftOut) {
    SceneDescription description = scene();
    description.textures.push_back(checkers({0, 0, 0}, {1, 1, 1}));
    description.shapes.push_back(rectangle("r"));
    EXPECT_TRUE(compileScene(description, {}).textures.empty());
}

TEST(CompileTextures, ReflectancesAboveOneNeedADepthLimit) {
    const TextureDescription bright = bitmap({2, 2}, {{0.5f, 1.5f, 0}, {2, 0, 0}, {0, 0, 0}, {0, 1, 0}});
    SceneDescription description = textured({rectangle("r")}, bright);
    EXPECT_TRUE(contains(inputErrorOf(description), "2 of its colours are above 1, up to 2"));
    description.integrator.maxDepth = 3;
    const CompiledScene scene = compileScene(description, {});
    EXPECT_TRUE(std::ranges::any_of(scene.notes, [](const auto& note) { return contains(note, "above 1, up to 2"); }));
    // Tinted to 1 at most, it is a reflectance like any other.
    EXPECT_EQ(inputErrorOf(textured({rectangle("r")}, bright, glm::dvec3(0.5))), "");
}

// Whole periods leave the translation in double: at 1e15 float has none of it left.
TEST(CompileTextures, TranslationKeepsItsFractionH73) {
    TextureDescription texture = bitmap({2, 1}, {{0, 0, 0}, {1, 1, 1}});
    texture.uvTransform[2] = {1e15 + 0.25, -1e9 - 0.75, 1};
    const CompiledScene scene = compileScene(textured({rectangle("r")}, texture), {});
    EXPECT_EQ(scene.textures.at(0).translation, glm::vec2(0.25f, 1.25f));
}

TEST(CompileTextures, TrianglesHaveCoordinatesInTheirOrder) {
    ShapeDescription mesh = tetrahedron("t");
    for (const glm::dvec3& p : mesh.mesh.positions) mesh.mesh.uvs.emplace_back(p.x + 2 * p.y, p.z);
    for (const bool flips : {false, true}) {
        mesh.flipNormals = flips;
        const CompiledScene scene = compileScene(textured({mesh}, checkers({0, 0, 0}, {1, 1, 1})), {});
        ASSERT_EQ(scene.triangleUvs.size(), scene.triangles.size());
        for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
            const glm::dvec3 p = glm::dvec3(scene.triangles[i]) + scene.worldOrigin;
            EXPECT_NEAR(scene.triangleUvs[i].x, p.x + 2 * p.y, 1e-5);
            EXPECT_NEAR(scene.triangleUvs[i].y, p.z, 1e-5);
        }
    }
}

TEST(CompileTextures, MeshWithoutCoordinatesIsNoted) {
    const CompiledScene scene = compileScene(textured({tetrahedron("t")}, checkers({0, 0, 0}, {1, 1, 1})), {});
    EXPECT_TRUE(
        std::ranges::any_of(scene.notes, [](const auto& note) { return contains(note, "no texture coordinates"); }));
}

TEST(CompileTextures, PowerOfALightIsItsTexturesMean) {
    SceneDescription description = scene();
    description.textures.push_back(checkers({0, 0, 0}, glm::dvec3(1)));
    ShapeDescription lamp = emissive(rectangle("lamp"), glm::dvec3(2));
    lamp.radianceTexture = 0;
    description.shapes = {lamp, emissive(rectangle("plain"), glm::dvec3(1))};
    const CompiledScene scene = compileScene(description, {});
    EXPECT_EQ(scene.constants.lights[0].texture, 0u);
    EXPECT_EQ(scene.constants.lights[0].emission, glm::vec3(2));
    EXPECT_NEAR(scene.constants.lights[0].selection, 0.5, 1e-6);  // 2 on half of it: as the plain one
    EXPECT_TRUE(scene.effects.has(Effect::hasTexturedLights));
    EXPECT_FALSE(scene.effects.has(Effect::hasTextures));
}

TEST(CompileTextures, BlackLightIsDropped) {
    SceneDescription description = scene();
    description.textures.push_back(bitmap({1, 2}, {glm::vec3(0), glm::vec3(0)}));
    ShapeDescription lamp = emissive(rectangle("lamp"), glm::dvec3(2));
    lamp.radianceTexture = 0;
    description.shapes = {lamp};
    const CompiledScene scene = compileScene(description, {});
    EXPECT_EQ(scene.constants.lightCount, 0u);
    EXPECT_TRUE(std::ranges::any_of(scene.notes, [](const auto& note) { return contains(note, "light is black"); }));
}

}  // namespace
}  // namespace parhelion
