#include "compile/control_pixels.h"

#include <algorithm>
#include <random>

namespace parhelion {

ControlPixels chooseControlPixels(glm::uvec2 size, std::uint32_t seed) {
    std::uint32_t edge = 16;
    const auto tiles = [&] { return (size + edge - 1u) / edge; };
    while (edge > 1 && std::uint64_t{tiles().x} * tiles().y < kLeastControls) edge /= 2;
    std::mt19937 random(seed);
    std::vector<std::uint32_t> pixels;
    for (std::uint32_t y = 0; y < size.y; y += edge)
        for (std::uint32_t x = 0; x < size.x; x += edge) {
            const glm::uvec2 extent = glm::min(glm::uvec2(edge), size - glm::uvec2(x, y));
            const std::uint32_t drawn =
                static_cast<std::uint32_t>(std::uint64_t{random()} * (extent.x * extent.y) >> 32);
            pixels.push_back((y + drawn / extent.x) * size.x + x + drawn % extent.x);
        }
    std::ranges::sort(pixels);
    return {edge, std::move(pixels)};
}

}  // namespace parhelion
