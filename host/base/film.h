#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shared/path_types.h"

namespace parhelion {

/// Rectangle of pixels, origin at the top left of the film.
struct PixelRect {
    glm::uvec2 offset{0, 0};
    glm::uvec2 size{0, 0};
};

/// A pixel of the image that was rendered again, with random numbers that the image has no part in.
struct ControlPixel {
    std::uint32_t pixel = 0;  ///< index in Film::pixels
    std::array<shared::FilmPixel, shared::kControlRuns> runs{};
};

/// The accumulated film of a render: what both back ends produce.
struct Film {
    glm::uvec2 filmSize{0, 0};                   ///< whole film, pixels
    PixelRect crop;                              ///< the part rendered
    bool stratified = false;                     ///< samples of a pixel are not independent of each other
    double radianceUnit = 1.0;                   ///< a power of two: what 1 stands for in pixels and layers
    std::uint64_t samples = 0;                   ///< samples per pixel, the same for every pixel
    std::vector<std::uint64_t> pixelSamples;     ///< of a render under way: samples in each of `pixels`, or empty
    std::vector<shared::FilmPixel> pixels;       ///< crop.size.x * crop.size.y, row by row from the top
    std::vector<ControlPixel> controls;          ///< ascending by pixel, with the samples of that pixel; empty: none
    std::uint32_t controlTileEdge = 0;           ///< one of the controls is in each square tile of this edge
    std::vector<shared::FeaturePixel> features;  ///< same order; sums over featureSamples
    std::uint64_t featureSamples = 0;
    std::uint32_t depthLayers = 0;           ///< layers by number of scatterings, the last for all above; 0: none
    std::vector<shared::LayerPixel> layers;  ///< depthLayers a pixel, in the order of pixels
    std::array<std::uint64_t, shared::kCounterCount> counters{};  ///< summed over the render
};

}  // namespace parhelion
