// Transforms against closed forms and against Mitsuba 3.9.1's own numbers.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/transforms.h"
#include "support/temporary_folder.h"

namespace parhelion::test {
namespace {

// A handful of roundings of values below 10 in double precision.
constexpr double kRounding = 1e-14;
// Mitsuba's numbers below are single precision: 2^-24 relative, a few operations, values below 10.
constexpr double kSinglePrecision = 2e-6;

glm::dmat4 fromRows(const std::array<double, 12>& rows) {
    glm::dmat4 matrix(1.0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            matrix[column][row] = rows[static_cast<std::size_t>(4 * row + column)];
    return matrix;
}

glm::dmat4 parseTransform(const std::string& steps) {
    const TemporaryFolder folder;
    return readTransform(readXml(folder.write("t.xml", "<transform name=\"to_world\">" + steps + "</transform>")));
}

void expectNear(const glm::dmat4& actual, const glm::dmat4& expected, double tolerance) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            EXPECT_NEAR(actual[column][row], expected[column][row], tolerance)
                << "row " << row << ", column " << column;
}

TEST(SceneTransform, StepsMatchTheirMatrices) {
    expectNear(parseTransform(R"(<translate x="1" z="-2"/>)"), fromRows({1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, -2}), 0.0);
    expectNear(parseTransform(R"(<translate value="1, 2, 3"/>)"), fromRows({1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3}), 0.0);
    expectNear(parseTransform(R"(<scale value="2"/>)"), fromRows({2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0}), 0.0);
    expectNear(parseTransform(R"(<scale y="3"/>)"), fromRows({1, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1, 0}), 0.0);
    expectNear(parseTransform(R"(<matrix value="1 2 3 4 5 6 7 8 9 10 12 13 0 0 0 1"/>)"),
               fromRows({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 13}), 0.0);
    expectNear(parseTransform(R"(<matrix value="1 2 3, 4 5 6, 7 8 10"/>)"),
               fromRows({1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 10, 0}), 0.0);
    // About z by 30 degrees: x towards y.
    const double c = std::sqrt(3.0) / 2.0;
    expectNear(parseTransform(R"(<rotate z="1" angle="30"/>)"), fromRows({c, -0.5, 0, 0, 0.5, c, 0, 0, 0, 0, 1, 0}),
               kRounding);
}

TEST(SceneTransform, RotationAxisNeedNotBeOfUnitLength) {
    expectNear(parseTransform(R"(<rotate value="3, 0, 4" angle="50"/>)"),
               parseTransform(R"(<rotate value="0.6, 0, 0.8" angle="50"/>)"), kRounding);
}

TEST(SceneTransform, MatchesMitsuba) {
    // mi.load_string(...)['to_world'] of each.
    expectNear(parseTransform(R"(<rotate value="0.6,0,0.8" angle="50"/>)"),
               fromRows({0.771384060382843, -0.6128355264663696, 0.17146195471286774, 0, 0.6128355264663696,
                         0.6427876353263855, -0.4596266746520996, 0, 0.17146195471286774, 0.4596266746520996,
                         0.8714035153388977, 0}),
               kSinglePrecision);
    expectNear(parseTransform(R"(<lookat origin="1,2,3" target="0,0.5,0" up="0,1,0"/>)"),
               fromRows({-0.9486833214759827, -0.13552618026733398, -0.2857142984867096, 1, 0, 0.9035078883171082,
                         -0.4285714328289032, 2, 0.3162277638912201, -0.40657857060432434, -0.8571428656578064, 3}),
               kSinglePrecision);
}

TEST(SceneTransform, LaterStepsApplyAfterEarlierOnes) {
    // Mitsuba's matrix. The wrong order would scale the translation: (4, 6, -2) in the last column.
    expectNear(parseTransform(R"(<scale x="2" y="3" z="4"/><rotate y="1" angle="90"/><translate x="1" y="2" z="3"/>)"),
               fromRows({0, 0, 4, 1, 0, 3, 0, 2, -2, 0, 0, 3}), kRounding);
}

TEST(SceneTransform, LookAtPutsPlusXToTheLeft) {
    // As Mitsuba's camera has it: left = up x direction.
    const glm::dmat4 matrix = lookAtMatrix({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
    EXPECT_EQ(glm::dvec3(matrix[2]), glm::dvec3(0, 0, -1));
    EXPECT_EQ(glm::dvec3(matrix[0]), glm::dvec3(-1, 0, 0));
}

TEST(SceneTransform, SimilarityKeepsAngles) {
    EXPECT_TRUE(similarityOf(parseTransform(R"(<scale value="3"/><rotate value="1,2,3" angle="40"/>)")).holds);
    EXPECT_NEAR(similarityOf(parseTransform(R"(<scale value="3"/><rotate y="1" angle="40"/>)")).scale, 3.0, kRounding);
    EXPECT_TRUE(similarityOf(parseTransform(R"(<scale x="-1"/>)")).holds);
    EXPECT_FALSE(similarityOf(parseTransform(R"(<scale x="1.001"/>)")).holds);
    EXPECT_FALSE(similarityOf(parseTransform(R"(<matrix value="1 0.001 0 0 1 0 0 0 1"/>)")).holds);
}

TEST(SceneTransform, LookAtWithoutUpTurnsAsMitsubas) {
    // The first two columns of Mitsuba 3.9.1's to_world.
    const auto expectAxes = [](const std::string& lookat, glm::dvec3 left, glm::dvec3 up) {
        const glm::dmat4 matrix = parseTransform("<lookat " + lookat + "/>");
        EXPECT_LT(glm::length(glm::dvec3(matrix[0]) - left), kSinglePrecision) << lookat;
        EXPECT_LT(glm::length(glm::dvec3(matrix[1]) - up), kSinglePrecision) << lookat;
    };
    const glm::dvec3 left(-0.05085137, 0.89829725, -0.43643579), up(0.97457433, -0.05085137, -0.21821789);
    expectAxes(R"(origin="1,2,4" target="0,0,0")", left, up);
    expectAxes(R"(origin="1,2,4" target="0,0,0" up="")", left, up);
    expectAxes(R"(origin="1,2,4" target="0,0,0" up="0,0,0")", left, up);
    expectAxes(R"(origin="0,0,0" target="2,2,2")", {0.21132487, -0.78867513, 0.57735026},
               {0.78867513, -0.21132487, -0.57735026});
    expectAxes(R"(origin="0,4,0" target="0,0,0")", {0, 0, -1}, {1, 0, 0});
}

}  // namespace
}  // namespace parhelion::test
