#include <gtest/gtest.h>

#include "support/environment_table.h"
#include "support/paths.h"
#include "support/shared_data.h"

// Measured environments against Mitsuba in 2000 directions each; in more: tests/nightly/environment_table_test.cpp.
namespace parhelion {
namespace {

TEST(MeasuredEnvironments, HaveMitsubasRadiance) {
    const std::filesystem::path folder = test::sharedFile("data/environments");
    if (folder.empty()) GTEST_SKIP() << "../shared/data/environments is missing";
    test::expectTableAgrees(
        std::filesystem::path(test::projectFolder()) / "tests/references/shared_environment_maps.csv", folder,
        "parity/environment.comp", 1);
}

}  // namespace
}  // namespace parhelion
