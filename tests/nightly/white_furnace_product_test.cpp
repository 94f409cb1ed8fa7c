#include <gtest/gtest.h>

#include <tuple>

#include "support/furnace.h"

// The white furnace of tests/statistical/white_furnace_test.cpp on 8 x 8 pixels, and its z-tests in media so thick that
// 0.1 % takes ten million paths.
namespace parhelion {
namespace {

using namespace test;

class WhiteFurnaceProduct : public testing::TestWithParam<std::tuple<Backend, bool, double>> {};

TEST_P(WhiteFurnaceProduct, EveryPixelIsWhite) {
    const auto [backend, isGrid, g] = GetParam();
    for (const double tau : {0.1, 10.0, 1000.0}) expectWhite(backend, {.tau = tau, .g = g, .isGrid = isGrid});
}

TEST_P(WhiteFurnaceProduct, SkySamplingLeavesTheMeanAtOne) {
    const auto [backend, isGrid, g] = GetParam();
    // The variance of one sample is 0.11 to 0.4: 0.1 % at z = 7.2 takes 5 to 21 million.
    const std::uint64_t samples = g == 0 ? 5500 : 2000;
    expectWhiteOnAverage(backend, {.tau = 10, .g = g, .isGrid = isGrid, .sampleSky = true, .size = 64}, samples);
}

std::string nameOf(const testing::TestParamInfo<std::tuple<Backend, bool, double>>& info) {
    const auto [backend, isGrid, g] = info.param;
    return std::string(name(backend)) + (isGrid ? "Grid" : "Sphere") +
           (g < 0   ? "Backward"
            : g > 0 ? "Forward"
                    : "Isotropic");
}

INSTANTIATE_TEST_SUITE_P(OnBothBackEnds, WhiteFurnaceProduct,
                         testing::Combine(testing::ValuesIn(kBackends), testing::Bool(),
                                          testing::Values(-0.9, 0.0, 0.9)),
                         nameOf);

}  // namespace
}  // namespace parhelion
