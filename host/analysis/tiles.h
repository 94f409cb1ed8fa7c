#pragma once

#include <algorithm>
#include <vector>

#include "base/film.h"

namespace parhelion {

/// Edge of the square tiles that comparisons average over, pixels: between the image mean, which sees a global bias,
/// and single pixels, whose noise hides all but gross errors.
inline constexpr unsigned kTileEdge = 8;

/// Squares of `edge` pixels that cover an image, row by row; those at the right and lower border may be smaller.
inline std::vector<PixelRect> tilesOf(glm::uvec2 size, unsigned edge) {
    std::vector<PixelRect> tiles;
    for (unsigned y = 0; y < size.y; y += edge)
        for (unsigned x = 0; x < size.x; x += edge)
            tiles.push_back({.offset = {x, y}, .size = {std::min(edge, size.x - x), std::min(edge, size.y - y)}});
    return tiles;
}

/// Calls visit(index) for the pixels of a rectangle, row by row; index counts the pixels of the whole image.
template <typename Visit>
void forEachPixel(const PixelRect& rect, unsigned imageWidth, const Visit& visit) {
    for (unsigned y = rect.offset.y; y < rect.offset.y + rect.size.y; ++y)
        for (unsigned x = rect.offset.x; x < rect.offset.x + rect.size.x; ++x) visit(std::size_t{y} * imageWidth + x);
}

}  // namespace parhelion
