#include <fmt/format.h>
#include <gtest/gtest.h>

#include <tuple>

#include "support/shared_data.h"
#include "support/slab.h"

// Every row of the table of exact slabs, at every scale, at both angles of incidence, on both back ends. The scales
// share the 0.2 %: that they are the same, Slabs.DependOnOpticalThicknessAlone shows path by path.
namespace parhelion {
namespace {

using namespace test;

using View = std::tuple<Backend, double, bool>;  ///< mu, lit from above

class SlabTable : public testing::TestWithParam<View> {};

TEST_P(SlabTable, HoldsTo2PerMille) {
    const auto table = sharedFile("references/slabs.csv");
    if (table.empty()) GTEST_SKIP() << "../shared/references/slabs.csv is missing";
    const auto [backend, mu, litFromAbove] = GetParam();
    const std::vector<SlabRow> rows = readSlabRows(table);
    ASSERT_GE(rows.size(), 25u);
    constexpr double kThicknesses[] = {1e-3, 1, 1e3};
    SlabScores all(3 * rows.size());
    std::uint32_t seed = 3000;  // pooled estimates must be independent
    for (const double thickness : kThicknesses) {
        SlabScores scores(3 * rows.size());
        for (const SlabRow& row : rows) {
            const SlabView view{.mu = mu, .litFromAbove = litFromAbove, .thickness = thickness};
            const CompiledScene scene = slabScene(row, view);
            const Film film = renderOn(backend, scene, samplesFor(scene, litFromAbove ? 3e6 : 2e5), ++seed);
            EXPECT_EQ(countAnomalies(film), 0u);
            scores.add(imageMean(film), row.exact(mu, litFromAbove), row.name());
        }
        scores.expectNoCommonBias(0.0035, fmt::format("thickness {}", thickness));
        all.pool(scores);
    }
    all.expectNoCommonBias(0.002, "all scales");
}

std::string nameOf(const testing::TestParamInfo<View>& info) {
    const auto [backend, mu, litFromAbove] = info.param;
    return fmt::format("{}{}{}", name(backend), mu == 1 ? "Normal" : "Slanted",
                       litFromAbove ? "Reflected" : "Transmitted");
}

class DualSlab : public testing::TestWithParam<View> {};

// The row with two lobes by itself. It absorbs nothing: a path ends in the sky or in the black plane, so that the
// variance is exact (1 - exact), and 7.22 standard errors are found with 99 % power at 1e-6.
TEST_P(DualSlab, HoldsTo2PerMilleAlone) {
    const auto table = sharedFile("references/slabs.csv");
    if (table.empty()) GTEST_SKIP() << "../shared/references/slabs.csv is missing";
    const auto [backend, mu, litFromAbove] = GetParam();
    std::size_t found = 0;
    for (const SlabRow& row : readSlabRows(table)) {
        if (row.weight == 1) continue;
        ++found;
        ASSERT_EQ(row.albedo, 1);
        const SlabView view{.mu = mu, .litFromAbove = litFromAbove};
        const double exact = row.exact(mu, litFromAbove);
        const double paths = 7.3 / 0.002 * (7.3 / 0.002) * (1 - exact) / exact;
        const Film film = renderOn(backend, slabScene(row, view), std::uint64_t(paths / (view.size * view.size)), 4000);
        EXPECT_EQ(countAnomalies(film), 0u);
        SlabScores scores(1);
        scores.add(imageMean(film), exact, row.name());
        scores.expectNoCommonBias(0.002, row.name());
    }
    EXPECT_GE(found, 1u);
}

INSTANTIATE_TEST_SUITE_P(OnBothBackEnds, DualSlab,
                         testing::Combine(testing::ValuesIn(kBackends), testing::Values(1.0, 0.5), testing::Bool()),
                         nameOf);

INSTANTIATE_TEST_SUITE_P(OnBothBackEnds, SlabTable,
                         testing::Combine(testing::ValuesIn(kBackends), testing::Values(1.0, 0.5), testing::Bool()),
                         nameOf);

}  // namespace
}  // namespace parhelion
