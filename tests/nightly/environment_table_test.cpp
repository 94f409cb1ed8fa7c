#include "support/environment_table.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "support/shared_data.h"

// Measured environments against Mitsuba in 1e5 directions each (tests/render/measured_environments_test.cpp has 2000),
// from a table that is too large to keep:
//   tools/mitsuba/environment_maps.py --shared 100000 --output TABLE; PARHELION_ENVIRONMENT_TABLE=TABLE
namespace parhelion {
namespace {

TEST(EnvironmentTable, RadianceOfMeasuredMapsIsMitsubas) {
    const char* const table = std::getenv("PARHELION_ENVIRONMENT_TABLE");
    if (!table) GTEST_SKIP() << "PARHELION_ENVIRONMENT_TABLE names no table of tools/mitsuba/environment_maps.py";
    const std::filesystem::path folder = test::sharedFile("data/environments");
    if (folder.empty()) GTEST_SKIP() << "../shared/data/environments is missing";
    test::expectTableAgrees(table, folder, "parity/environment.comp", 1);
}

}  // namespace
}  // namespace parhelion
