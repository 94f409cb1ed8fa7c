#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace parhelion {

/// Pixels that are rendered again, shared::kControlRuns times, with random numbers of their own, so that a render can
/// measure its error on what has no part in its picture: one of each square tile, drawn at random.
struct ControlPixels {
    std::uint32_t tileEdge = 0;         ///< pixels; tiles start at the crop's top left
    std::vector<std::uint32_t> pixels;  ///< indices in crop order, row by row from the top; ascending
};

/// So many pairs of equally noisy pixels know the variance to sqrt(2 / 256) = 9 %, the error to 4.5 %.
inline constexpr std::uint32_t kLeastControls = 256;

/// Tiles have an edge of 16 pixels, so that the extra work is 2 / 256 of the image's; where fewer than kLeastControls
/// of those cover the film 8, 4, 2 or 1.
/// @param size  of the film's crop, pixels.
ControlPixels chooseControlPixels(glm::uvec2 size, std::uint32_t seed);

}  // namespace parhelion
