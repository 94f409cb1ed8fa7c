#include "compile/control_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace parhelion {
namespace {

// One in each tile, whatever the film's size, and every pixel of a tile as likely as another.
TEST(ControlPixels, OneIsInEachTile) {
    for (const glm::uvec2 size : {glm::uvec2(256, 256), {960, 540}, {37, 21}, {1, 1}, {1000, 3}, {16, 16}}) {
        const ControlPixels controls = chooseControlPixels(size, 3);
        const glm::uvec2 tiles = (size + controls.tileEdge - 1u) / controls.tileEdge;
        std::map<std::uint32_t, int> inTile;
        for (const std::uint32_t pixel : controls.pixels) {
            ASSERT_LT(pixel, size.x * size.y);
            ++inTile[pixel / size.x / controls.tileEdge * tiles.x + pixel % size.x / controls.tileEdge];
        }
        EXPECT_EQ(inTile.size(), std::size_t{tiles.x} * tiles.y);
        EXPECT_EQ(controls.pixels.size(), inTile.size());
        EXPECT_TRUE(std::ranges::is_sorted(controls.pixels));
        EXPECT_TRUE(controls.pixels.size() >= kLeastControls || controls.tileEdge == 1);
    }
}

TEST(ControlPixels, CostsLittleWhereTimeMatters) {
    EXPECT_LE(2 * chooseControlPixels({256, 256}, 0).pixels.size(), 256u * 256 / 100);
    EXPECT_LE(2 * chooseControlPixels({1920, 1080}, 0).pixels.size(), 1920u * 1080 / 100);
}

TEST(ControlPixels, EveryPixelIsAsLikely) {
    std::map<std::uint32_t, int> hits;
    constexpr int kSeeds = 64'000;
    // The first tile of a film of 64 x 64 has an edge of 4.
    for (std::uint32_t seed = 0; seed < kSeeds / 16; ++seed)
        for (const std::uint32_t pixel : chooseControlPixels({64, 64}, seed).pixels)
            ++hits[pixel / 64 % 4 * 4 + pixel % 4];
    double chiSquare = 0;
    const double expected = kSeeds / 16 * 256 / 16.0;
    for (const auto& [pixel, count] : hits) chiSquare += (count - expected) * (count - expected) / expected;
    EXPECT_EQ(hits.size(), 16u);
    EXPECT_LT(chiSquare, 60);  // 15 degrees of freedom: 3e-7
}

}  // namespace
}  // namespace parhelion
