#pragma once

#include "reference/core/scene.h"

namespace parhelion::reference {

/// One axis of a texture coordinate, brought into the wrap mode's period.
template <typename Real>
Real wrapCoordinate(Real x, std::uint32_t flags) {
    if (flags & shared::kTextureClamp) return std::clamp(x, Real(0), Real(1));
    if (flags & shared::kTextureMirror) return x - 2 * std::floor(x / 2);
    return x - std::floor(x);
}

/// Texel that index i of an axis stands for.
template <typename Index>
Index wrapTexel(Index i, Index size, std::uint32_t flags) {
    if (flags & shared::kTextureClamp) return std::clamp(i, Index(0), size - 1);
    const auto modulo = [&](Index n) { return ((i % n) + n) % n; };
    if (!(flags & shared::kTextureMirror)) return modulo(size);
    const Index within = modulo(2 * size);
    return within < size ? within : 2 * size - 1 - within;
}

/// Colour of a bitmap.
///
/// @param uv  finite, after the texture's transform.
template <typename Real>
Vec3<Real> bitmapAt(const CompiledScene& scene, const shared::Texture& texture, const Vec2<Real>& uv) {
    const Vec2<Real> count(wrapCoordinate(uv.x, texture.flags) * Real(texture.size.x),
                           wrapCoordinate(uv.y, texture.flags) * Real(texture.size.y));
    const auto texel = [&](std::int64_t x, std::int64_t y) {
        const std::int64_t column = wrapTexel(x, std::int64_t(texture.size.x), texture.flags);
        const std::int64_t row = wrapTexel(y, std::int64_t(texture.size.y), texture.flags);
        return Vec3<Real>(
            scene.textureTexels[texture.offset + std::size_t(row) * texture.size.x + std::size_t(column)]);
    };
    if (texture.flags & shared::kTextureNearest) {
        // A coordinate that rounding has put on the end of its period belongs to the last texel, not to the first.
        const Vec2<Real> end = Vec2<Real>(texture.size) * Real(texture.flags & shared::kTextureMirror ? 2 : 1);
        const auto at = [&](int axis) { return std::int64_t(std::min(std::floor(count[axis]), end[axis] - 1)); };
        return texel(at(0), at(1));
    }
    const Vec2<Real> corner(std::floor(count.x - Real(0.5)), std::floor(count.y - Real(0.5)));
    const Vec2<Real> f = count - Real(0.5) - corner;
    const auto x = std::int64_t(corner.x), y = std::int64_t(corner.y);
    return (texel(x, y) * (1 - f.x) + texel(x + 1, y) * f.x) * (1 - f.y) +
           (texel(x, y + 1) * (1 - f.x) + texel(x + 1, y + 1) * f.x) * f.y;
}

/// color0 where both or neither of the coordinates are in the upper half of their period.
template <typename Real>
Vec3<Real> checkerboardAt(const shared::Texture& texture, const Vec2<Real>& uv) {
    const auto isUpper = [](Real x) { return x - std::floor(x) > Real(0.5); };
    return Vec3<Real>(isUpper(uv.x) == isUpper(uv.y) ? texture.color0 : texture.color1);
}

/// Colour of a texture at (u, v) of a surface; white where there is none.
template <typename Real>
Vec3<Real> textureAt(const CompiledScene& scene, std::uint32_t index, const Vec2<Real>& uv) {
    if (index == kNone) return Vec3<Real>(1);
    const shared::Texture& texture = scene.textures[index];
    const Vec2<Real> transformed =
        uv.x * Vec2<Real>(texture.transformU) + uv.y * Vec2<Real>(texture.transformV) + Vec2<Real>(texture.translation);
    return texture.flags & shared::kTextureCheckerboard ? checkerboardAt(texture, transformed)
                                                        : bitmapAt(scene, texture, transformed);
}

/// Reflectance of a surface at its (u, v).
template <typename Real>
Vec3<Real> reflectanceAt(const CompiledScene& scene, const shared::Shape& shape, const Vec2<Real>& uv) {
    return Vec3<Real>(shape.reflectance) * textureAt(scene, shape.texture, uv);
}

}  // namespace parhelion::reference
