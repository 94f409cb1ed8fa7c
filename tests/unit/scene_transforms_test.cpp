// Transforms and fields of view against closed forms and against Mitsuba 3.9.1's own numbers.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/read_sensor.h"
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
    // formats.md, and Mitsuba's camera: left = up x direction.
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

struct FovCase {
    FovAxis axis;
    double wide, tall, square;  ///< expected horizontal degrees at 300 x 200, 200 x 300, 48 x 48
};

TEST(HorizontalFov, MatchesMitsubaForEveryAxis) {
    // params['x_fov'] of Mitsuba for fov = 40. x: 40. y: 2 atan(tan 20 * aspect).
    // diagonal: 2 atan(tan 20 / sqrt(1 + 1 / aspect^2)). smaller, larger: x or y, whichever the film's side is.
    const FovCase cases[] = {{FovAxis::X, 40.0, 40.0, 40.0},
                             {FovAxis::Y, 57.265140533447266, 27.278078079223633, 40.0},
                             {FovAxis::Diagonal, 33.696983337402344, 22.82851791381836, 28.865510940551758},
                             {FovAxis::Smaller, 57.265140533447266, 40.0, 40.0},
                             {FovAxis::Larger, 40.0, 27.278078079223633, 40.0}};
    constexpr double kDegrees =
        1e-5;  // single precision of numbers below 64: 64 * 2^-24, and a tangent and its inverse
    for (const FovCase& expected : cases) {
        EXPECT_NEAR(horizontalFov(40.0, expected.axis, 1.5), expected.wide, kDegrees);
        EXPECT_NEAR(horizontalFov(40.0, expected.axis, 1.0 / 1.5), expected.tall, kDegrees);
        EXPECT_NEAR(horizontalFov(40.0, expected.axis, 1.0), expected.square, kDegrees);
    }
}

TEST(HorizontalFov, FollowsTheLensOnThirtyFiveMillimetreFilm) {
    // Mitsuba's x_fov for focal_length 50 mm and 35 mm: 2 atan(sqrt(36^2 + 24^2) / (2 f)) along the diagonal.
    constexpr double kDegrees = 1e-5;
    const auto lens = [](double focalLength, double aspect) {
        return horizontalFov(diagonalFovOfLens(focalLength), FovAxis::Diagonal, aspect);
    };
    EXPECT_NEAR(lens(50.0, 1.5), 39.59775161743164, kDegrees);
    EXPECT_NEAR(lens(50.0, 1.0 / 1.5), 26.991466522216797, kDegrees);
    EXPECT_NEAR(lens(50.0, 1.0), 34.022056579589844, kDegrees);
    EXPECT_NEAR(lens(35.0, 1.5), 54.43222427368164, kDegrees);
    EXPECT_NEAR(lens(35.0, 1.0), 47.21631622314453, kDegrees);
    // On film of its own shape a lens sees 36 mm across.
    EXPECT_NEAR(lens(50.0, 1.5), glm::degrees(2.0 * std::atan(36.0 / 100.0)), kRounding * 100);
}

}  // namespace
}  // namespace parhelion::test
