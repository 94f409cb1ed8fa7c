#include <gtest/gtest.h>

#include "support/furnace.h"

// What absorbs nothing in a uniform sky looks like the sky: L = 1 whatever shape, density and phase function
// (H34). tests/nightly/white_furnace_product_test.cpp has larger crops and the thick ones of the z-tests.
namespace parhelion {
namespace {

using namespace test;

class WhiteFurnace : public testing::TestWithParam<Backend> {};

TEST_P(WhiteFurnace, HomogeneousMediaAreWhiteInEveryPixel) {
    for (const double tau : {0.1, 10.0, 1000.0})
        for (const double g : {-0.9, 0.0, 0.9}) expectWhite(GetParam(), {.tau = tau, .g = g, .size = 4});
}

TEST_P(WhiteFurnace, GridsAreWhiteInEveryPixel) {
    for (const double tau : {0.1, 10.0})
        for (const double g : {-0.9, 0.0, 0.9})
            expectWhite(GetParam(), {.tau = tau, .g = g, .isGrid = true, .size = 8});
}

TEST_P(WhiteFurnace, ThickGridsAreWhiteInEveryPixel) {
    for (const double g : {-0.9, 0.0, 0.9}) expectWhite(GetParam(), {.tau = 1000, .g = g, .isGrid = true, .size = 4});
}

// Sampling the sky at every scattering makes each sample vary; the weights of both techniques must add up to 1.
// Samples: what the variance asks for, twice over.
TEST_P(WhiteFurnace, SkySamplingLeavesTheMeanAtOne) {
    for (const bool isGrid : {false, true})
        for (const double g : {-0.9, 0.0, 0.9})
            expectWhiteOnAverage(GetParam(), {.tau = 0.1, .g = g, .isGrid = isGrid, .sampleSky = true, .size = 32},
                                 1000);
}

// Red light meets a twentieth of the extinction: spectral MIS weighs paths of hundreds of scatterings, on which the
// density under two of the three heroes sinks far below the smallest float (H37). Weights lie in [0, 3] with mean 1, so
// that their variance is at most 2: 2 % takes 2 (7.22 / 0.02)^2 = 2.6e5 paths.
TEST_P(WhiteFurnace, DeepChromaticPathsKeepTheirWeight) {
    expectWhiteOnAverage(GetParam(), {.tau = 400, .size = 16, .red = 0.05}, 1050, 0.02);
}

INSTANTIATE_TEST_SUITE_P(OnTheDevice, WhiteFurnace, testing::Values(Backend::Vulkan));
INSTANTIATE_TEST_SUITE_P(NightlyOnTheReference, WhiteFurnace, testing::Values(Backend::Reference));

}  // namespace
}  // namespace parhelion
