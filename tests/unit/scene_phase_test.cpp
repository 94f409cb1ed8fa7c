// Phase functions from scene text to what is rendered, against Mitsuba's values by angle.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "reference/volume/phase_function.h"
#include "support/paths.h"
#include "support/phase_cases.h"
#include "support/scene_reading.h"

namespace parhelion::test {
namespace {

PhaseDescription readPhaseText(const std::string& phase) {
    return readText(
               sceneOf("<shape type=\"cube\"><bsdf type=\"null\"/><medium type=\"homogeneous\" name=\"interior\">" +
                       phase + "</medium></shape>"))
        .media.at(0)
        .phase;
}

shared::Medium compiled(const PhaseDescription& phase) { return PhaseCase("phase", phase).record(); }

// Sign of the cosine, order of a table's values, meaning of a blend's weight. Mitsuba computes in single precision, and
// loses up to a / (1 - a)^2 = 40 roundings at the peak of g = 0.85.
TEST(PhaseText, MeansWhatItMeansInMitsuba) {
    std::ifstream file(test::projectFolder() + "/tests/references/phase_functions.csv");
    std::string line, text, mu, value;
    std::getline(file, line);
    int rows = 0;
    for (; std::getline(file, line); ++rows) {
        std::istringstream cells(line);
        std::getline(std::getline(std::getline(cells, text, ';'), mu, ';'), value);
        const PhaseCase phase("phase", readPhaseText(text));
        const double cosine = std::stod(mu), exact = std::stod(value);
        const glm::dvec3 wi{std::sqrt(std::max(0.0, 1 - cosine * cosine)), 0, cosine};
        EXPECT_NEAR(reference::evalPhase(phase.medium<double>(), glm::dvec3(0, 0, -1), wi) / exact, 1, 1e-5) << line;
    }
    EXPECT_EQ(rows, 105);
}

TEST(PhaseText, DualLobesAreNamed) {
    const PhaseDescription phase = readPhaseText(R"(<phase type="dual_hg"><float name="g1" value="0.85"/>
<float name="g2" value="-0.3"/><float name="weight" value="0.7"/></phase>)");
    EXPECT_EQ(phase.g, 0.85);
    EXPECT_EQ(phase.g2, -0.3);
    EXPECT_EQ(phase.lobeWeight, 0.7);
    const shared::Medium record = compiled(phase);
    EXPECT_EQ(record.phase, shared::kPhaseDualHenyeyGreenstein);
    EXPECT_NEAR(record.lobeWeight, 0.7, 0x1p-25);
    EXPECT_EQ(std::fmod(record.lobeWeight * 0x1p24f, 1.0f), 0.0f) << "what 24 random bits decide exactly";
}

// H7: a weight of 0 or 1 is the one lobe, to the bit.
TEST(PhaseForms, AreReducedToTheSimplestH7) {
    const auto expectSame = [](const PhaseDescription& given, const PhaseDescription& simple) {
        const shared::Medium a = compiled(given), b = compiled(simple);
        EXPECT_EQ(a.phase, b.phase);
        EXPECT_EQ(a.g, b.g);
        EXPECT_EQ(a.phaseCount, b.phaseCount);
    };
    expectSame(dualHenyeyGreenstein(0.8, -0.2, 1), henyeyGreenstein(0.8));
    expectSame(dualHenyeyGreenstein(0.8, -0.2, 0), henyeyGreenstein(-0.2));
    expectSame(dualHenyeyGreenstein(0.8, -0.2, 1 - 1e-9), henyeyGreenstein(0.8));
    expectSame(dualHenyeyGreenstein(0.4, 0.4, 0.3), henyeyGreenstein(0.4));
    expectSame(dualHenyeyGreenstein(0, 0, 0.3), PhaseDescription{});
    expectSame(dualHenyeyGreenstein(0.5, 0, 0), PhaseDescription{});
    expectSame(henyeyGreenstein(0), PhaseDescription{});
    expectSame(tabulated({3, 3, 3}), PhaseDescription{});
    EXPECT_EQ(compiled(dualHenyeyGreenstein(0.5, 0, 0.3)).phase, shared::kPhaseDualHenyeyGreenstein);
    EXPECT_EQ(compiled(dualHenyeyGreenstein(1 - 1e-9, -1 + 1e-9, 0.5)).g, 1.0f - 0x1p-20f);
    EXPECT_EQ(compiled(dualHenyeyGreenstein(1 - 1e-9, -1 + 1e-9, 0.5)).g2, -1.0f + 0x1p-20f);
}

TEST(PhaseTables, AreNormalisedWhateverTheirRange) {
    for (const double scale : {1e-300, 1.0, 1e300}) {
        const PhaseCase phase("table", tabulated({0, scale, 3 * scale}));
        const std::vector<float>& table = phase.scene().phaseTable;
        ASSERT_EQ(table.size(), 3u);
        EXPECT_EQ(phase.scene().distributions.size(), 3u);
        EXPECT_EQ(table[0], 0.0f);
        EXPECT_NEAR(table[1], 1 / (5 * std::acos(-1.0)), 1e-8);  // 2 pi (1/2 + 4/2) = 5 pi
        EXPECT_EQ(table[2], 3 * table[1]);
    }
}

TEST(PhaseTables, ThatAreNoneAreRefusedWithTheirPlace) {
    const auto messageOf = [](std::vector<double> values) {
        PhaseDescription phase = tabulated(std::move(values));
        phase.where = {"scene.xml", 4, 2};
        try {
            compiled(phase);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(messageOf({1, -2}),
              "scene.xml:4:2: phase: value 1 of a tabulated phase function must be finite and >= 0; got -2");
    EXPECT_NE(messageOf({NAN, 1}).find("value 0"), std::string::npos);
    EXPECT_NE(messageOf({1, INFINITY}).find("got inf"), std::string::npos);
    EXPECT_NE(messageOf({0, 0}).find("zero everywhere"), std::string::npos);
    EXPECT_NE(messageOf({1}).find("2 to 65536 values; got 1"), std::string::npos);
    EXPECT_NE(messageOf(std::vector<double>(65537, 1.0)).find("got 65537"), std::string::npos);
}

}  // namespace
}  // namespace parhelion::test
