#include <gtest/gtest.h>

#include <tuple>

#include "support/mitsuba_reference.h"
#include "support/paths.h"
#include "support/shared_data.h"

// tests/statistical/mitsuba_agreement_test.cpp with more samples, on both back ends.
namespace parhelion {
namespace {

using namespace test;

class MitsubaPrecise : public testing::TestWithParam<std::tuple<MitsubaReference, Backend>> {};

TEST_P(MitsubaPrecise, ImageMeanTilesAndPixelsAreTheSame) {
    if (sharedFile("benchmark").empty() || sharedFile("data/mitsuba").empty())
        GTEST_SKIP() << "../shared/benchmark or ../shared/data/mitsuba is missing";
    const auto& [reference, backend] = GetParam();
    expectAgreement(reference, test::projectFolder(), backend);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, MitsubaPrecise,
    testing::Combine(
        testing::Values(MitsubaReference{"wdas_sun_sky", "../shared/benchmark/wdas_sun_sky.xml", 768, 0.003},
                        MitsubaReference{"cornell_cloud", "../shared/benchmark/cornell_cloud.xml", 768, 0.003},
                        MitsubaReference{"fog_small_light", "../shared/benchmark/fog_small_light.xml", 6144, 0.01,
                                         false},
                        MitsubaReference{"furnace", "../shared/benchmark/furnace.xml", 64, 0.003},
                        MitsubaReference{"hetero_sigmat", "tests/references/hetero_sigmat.xml", 512, 0.003},
                        MitsubaReference{"homo_null", "tests/references/homo_null.xml", 512, 0.003}),
        testing::ValuesIn(kBackends)),
    [](const auto& info) { return std::get<0>(info.param).name + "_" + name(std::get<1>(info.param)); });

}  // namespace
}  // namespace parhelion
