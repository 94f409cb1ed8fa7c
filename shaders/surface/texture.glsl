// Colours over a surface's (u, v): bitmaps and checkerboards.
#ifndef SURFACE_TEXTURE_GLSL
#define SURFACE_TEXTURE_GLSL

#include "core/scene.glsl"

// One axis within its period: [0, 1] under repeat and clamp, [0, 2] under mirror.
float wrapCoordinate(float x, uint flags) {
    float period = (flags & kTextureMirror) != 0u ? 2.0 : 1.0;
    float within = x - period * floor(x / period);
    return (flags & kTextureClamp) != 0u ? clamp(x, 0.0, 1.0) : within;
}

// Texel of an axis for an index of its period or next to it; a texel of the bitmap whatever the index.
int wrapTexel(int i, int size, uint flags) {
    int period = (flags & kTextureMirror) != 0u ? 2 * size : size;
    int j = i;
    if ((flags & kTextureClamp) == 0u) {
        j = i < 0 ? i + period : i >= period ? i - period : i;
        j = j >= size ? 2 * size - 1 - j : j;  // the mirrored half
    }
    return clamp(j, 0, size - 1);
}

// Colour of a bitmap at transformed coordinates. Nearest is bilinear without the second corner.
vec3 bitmapAt(Texture t, vec2 uv) {
    ivec2 size = ivec2(t.size);
    bool nearest = (t.flags & kTextureNearest) != 0u;
    vec2 count = vec2(wrapCoordinate(uv.x, t.flags), wrapCoordinate(uv.y, t.flags)) * vec2(size);
    ivec2 last = ((t.flags & kTextureMirror) != 0u ? 2 * size : size) - 1;
    ivec2 low = nearest ? min(ivec2(count), last) : ivec2(floor(count - 0.5));
    vec2 w = nearest ? vec2(0.0) : (count - 0.5) - vec2(low);
    int x0 = wrapTexel(low.x, size.x, t.flags), x1 = wrapTexel(low.x + 1, size.x, t.flags);
    int y0 = int(t.offset) + wrapTexel(low.y, size.y, t.flags) * size.x;
    int y1 = int(t.offset) + wrapTexel(low.y + 1, size.y, t.flags) * size.x;
    vec3 top = texelFetch(textureTexels, y0 + x0).xyz * (1.0 - w.x) + texelFetch(textureTexels, y0 + x1).xyz * w.x;
    vec3 bottom = texelFetch(textureTexels, y1 + x0).xyz * (1.0 - w.x) + texelFetch(textureTexels, y1 + x1).xyz * w.x;
    return top * (1.0 - w.y) + bottom * w.y;
}

vec3 checkerboardAt(Texture t, vec2 uv) {
    vec2 f = uv - floor(uv);
    return (f.x > 0.5) == (f.y > 0.5) ? t.color0 : t.color1;
}

// Colour of texture `index` at (u, v) of a surface; 1 for kNone.
vec3 textureAt(uint index, vec2 uv) {
    if (index == kNone) return vec3(1.0);
    int texel = int(6u * index);
    vec4 linear = texelFetch(textureRecords, texel), rest = texelFetch(textureRecords, texel + 1);
    uvec2 size = floatBitsToUint(texelFetch(textureRecords, texel + 2).xy);
    vec3 color0 = texelFetch(textureRecords, texel + 3).xyz, color1 = texelFetch(textureRecords, texel + 4).xyz;
    Texture t = Texture(linear.xy, linear.zw, rest.xy, floatBitsToUint(rest.z), floatBitsToUint(rest.w), size, 0u, 0u,
                        color0, 0u, color1, 0u, vec4(0.0));
    vec2 p = t.transformU * uv.x + t.transformV * uv.y + t.translation;
    if ((t.flags & kTextureCheckerboard) != 0u) return checkerboardAt(t, p);
    return bitmapAt(t, p);
}

// Reflectance of a surface at its (u, v).
vec3 reflectanceAt(Shape shape, vec2 uv) {
    if (!hasTextures) return shape.reflectance;
    return shape.reflectance * textureAt(shape.texture, uv);
}

#endif
