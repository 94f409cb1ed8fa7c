#include "compile/compile_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compile/transforms.h"

namespace parhelion {

namespace {

/// The colours a texture takes: its texels, or those of its checkers.
template <typename Visit>
void forEachColor(const TextureDescription& texture, Visit visit) {
    if (texture.type == TextureDescription::Type::Checkerboard) {
        visit(texture.color0);
        visit(texture.color1);
    }
    for (const glm::vec3& texel : texture.bitmap.texels) visit(glm::dvec3(texel));
}

std::uint32_t flagsOf(const TextureDescription& texture) {
    using Wrap = TextureDescription::Wrap;
    if (texture.type == TextureDescription::Type::Checkerboard) return shared::kTextureCheckerboard;
    const std::uint32_t wrap = texture.wrap == Wrap::Clamp    ? shared::kTextureClamp
                               : texture.wrap == Wrap::Mirror ? shared::kTextureMirror
                                                              : 0u;
    return wrap | (texture.nearest ? shared::kTextureNearest : 0u);
}

/// Whole periods of the translation are taken off in double; two suit the mirror as well.
glm::dvec2 reducedTranslation(const TextureDescription& texture) {
    const glm::dvec2 translation(texture.uvTransform[2]);
    return texture.wrap == TextureDescription::Wrap::Clamp ? translation
                                                           : translation - 2.0 * glm::floor(translation / 2.0);
}

class TextureCompiler {
public:
    TextureCompiler(const SceneDescription& description, CompiledScene& scene)
        : textures_(description.textures), scene_(scene) {}

    SurfaceTexture add(std::size_t index) {
        if (const auto found = added_.find(index); found != added_.end()) return found->second;
        const TextureDescription& texture = textures_[index];
        SurfaceTexture result;
        glm::dvec3 first(0.0), largest(0.0);
        std::size_t count = 0, same = 0;
        forEachColor(texture, [&](const glm::dvec3& color) {
            if (count == 0) first = color;
            same += color == first;
            largest = glm::max(largest, color);
            result.mean += (color - result.mean) / double(++count);
        });
        if (same == count) {
            result.mean = result.tint = first;
        } else {
            result.index = write(texture);
            result.largest = largest;
        }
        return added_[index] = result;
    }

    /// Where a tinted texture is no reflectance.
    void checkReflectance(std::size_t index, const glm::dvec3& tint) {
        const TextureDescription& texture = textures_[index];
        std::size_t above = 0;
        double largest = 0.0;
        forEachColor(texture, [&](const glm::dvec3& color) {
            const glm::dvec3 tinted = color * tint;
            const double value = std::max(tinted.x, std::max(tinted.y, tinted.z));
            above += value > 1.0;
            largest = std::max(largest, value);
        });
        if (above == 0) return;
        const std::string what =
            fmt::format("reflectance of texture: {} of its colours are above 1, up to {:.6g}", above, largest);
        if (scene_.constants.maxDepth == shared::kNone)
            throw InputError(texture.where, what +
                                                "; paths without a depth limit need not end there: scale the texture "
                                                "to [0, 1], or give the integrator a max_depth");
        scene_.notes.push_back(fmt::format("{}: {}", texture.where.text(), what));
    }

private:
    std::uint32_t write(const TextureDescription& texture) {
        shared::Texture record{};
        const std::string name = "texture: to_uv";
        const auto toFloat2 = [&](glm::dvec2 v) { return glm::vec2(toFloat(glm::dvec3(v, 0.0), texture.where, name)); };
        record.transformU = toFloat2(glm::dvec2(texture.uvTransform[0]));
        record.transformV = toFloat2(glm::dvec2(texture.uvTransform[1]));
        record.translation = toFloat2(reducedTranslation(texture));
        record.flags = flagsOf(texture);
        record.size = glm::max(texture.bitmap.size, glm::uvec2(1));
        record.offset = std::uint32_t(scene_.textureTexels.size());
        if (texture.type == TextureDescription::Type::Checkerboard) {
            record.color0 = toFloat(texture.color0, texture.where, "texture: color0");
            record.color1 = toFloat(texture.color1, texture.where, "texture: color1");
        } else {
            appendTexels(texture);
        }
        scene_.textures.push_back(record);
        return std::uint32_t(scene_.textures.size() - 1);
    }

    void appendTexels(const TextureDescription& texture) {
        const std::vector<glm::vec3>& texels = texture.bitmap.texels;
        if (scene_.textureTexels.size() + texels.size() > kMaxTexels)
            throw InputError(texture.where, fmt::format("the textures of a scene may have at most {} texels; with this "
                                                        "one they have {}",
                                                        kMaxTexels, scene_.textureTexels.size() + texels.size()));
        for (const glm::vec3& texel : texels) scene_.textureTexels.emplace_back(texel, 0.0f);
    }

    const std::vector<TextureDescription>& textures_;
    CompiledScene& scene_;
    std::map<std::size_t, SurfaceTexture> added_;  ///< by index in the description
};

void noteMissingUvs(const ShapeDescription& shape, CompiledScene& scene) {
    if (shape.type == ShapeDescription::Type::Mesh && shape.mesh.uvs.empty())
        scene.notes.push_back(fmt::format(
            "{}: {} has no texture coordinates: (u, v) are (0, 0), (1, 0), (0, 1) in every triangle, as in Mitsuba",
            shape.where.text(), nameOf(shape)));
}

}  // namespace

void compileTextures(const SceneDescription& description, std::span<KeptShape> shapes, CompiledScene& scene) {
    TextureCompiler textures(description, scene);
    for (KeptShape& kept : shapes) {
        const ShapeDescription& shape = *kept.placed->source;
        if (shape.bsdf.texture && !kept.placed->isNull()) {
            textures.checkReflectance(*shape.bsdf.texture, shape.bsdf.reflectance);
            kept.reflectance = textures.add(*shape.bsdf.texture);
        }
        if (shape.radianceTexture) kept.radiance = textures.add(*shape.radianceTexture);
        if (kept.isTextured()) noteMissingUvs(shape, scene);
    }
}

}  // namespace parhelion
