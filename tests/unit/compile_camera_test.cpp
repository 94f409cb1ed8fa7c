#include <gtest/gtest.h>

#include <cmath>

#include "compile/compile_film.h"
#include "scene/read_sensor.h"
#include "unit/compile_fixtures.h"

namespace parhelion {
namespace {

using namespace fixtures;

/// Mitsuba's look-at: +z towards the target, +x to the left.
glm::dmat4 lookAt(const glm::dvec3& origin, const glm::dvec3& target) {
    const glm::dvec3 z = glm::normalize(target - origin);
    const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), z));
    return glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(origin, 1));
}

struct Direction {
    glm::dvec2 pixel;
    glm::dvec3 expected;
};

struct View {
    const char* name;
    glm::dvec3 origin, target;
    double fov;
    glm::uvec2 size;
    glm::dvec2 principalPointOffset;
    std::vector<Direction> directions;  // from Mitsuba 3, scalar_rgb, sensor.sample_ray
};

std::vector<View> views() {
    return {{"wdas_sun_sky",
             {-2.6, 0.9, -2.2},
             {0, -0.03, 0},
             32,
             {256, 256},
             {0, 0},
             {{{0, 0}, {0.907526612, 0.0122367488, 0.419816405}},
              {{256, 0}, {0.564237177, 0.0122367488, 0.825522125}},
              {{100, 37.5}, {0.799896538, -0.0663581043, 0.596458018}},
              {{256, 256}, {0.457368672, -0.500449181, 0.735094965}}}},
            {"cornell_cloud",
             {0, 0, 3.9},
             {0, 0, 0},
             39.3,
             {256, 256},
             {0, 0},
             {{{0, 0}, {-0.318734854, 0.318734825, -0.892645538}},
              {{100, 37.5}, {-0.0755161792, 0.244079009, -0.966810465}}}},
            {"bunny_hdr_sky",
             {-0.12, 0.22, 0.36},
             {-0.017, 0.1, 0},
             35,
             {256, 256},
             {0, 0},
             {{{256, 0}, {0.540277719, -0.00450142194, -0.841474712}},
              {{100, 37.5}, {0.208746135, -0.09046413, -0.973776817}}}},
            {"principal point, 320 x 200",
             {1, 2, 3},
             {-1, 0.5, 0},
             50,
             {320, 200},
             {0.1, -0.07},
             {{{0, 0}, {-0.799163222, -0.0691998899, -0.597117603}},
              {{320, 0}, {-0.0983548686, -0.0648340061, -0.993037164}},
              {{77, 150}, {-0.603557289, -0.473213077, -0.641706944}}}}};
}

SceneDescription sceneOf(const View& view) {
    SceneDescription description = scene();
    description.camera.toWorld = lookAt(view.origin, view.target);
    description.camera.fovDegrees = view.fov;
    description.camera.principalPointOffset = view.principalPointOffset;
    description.film.size = view.size;
    return description;
}

TEST(CompiledCamera, DirectionsEqualMitsubas) {
    // Mitsuba's chain of float matrices is good to about 16 roundings of 1; a pixel is 2e-3 wide.
    constexpr double kTolerance = 16 * 0x1p-24;
    for (const View& view : views()) {
        const shared::Camera camera = compileScene(sceneOf(view)).constants.camera;
        for (const Direction& direction : view.directions) {
            const glm::dvec3 actual =
                glm::normalize(glm::dvec3(camera.forward) + direction.pixel.x * glm::dvec3(camera.dx) +
                               direction.pixel.y * glm::dvec3(camera.dy));
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_NEAR(actual[axis], direction.expected[axis], kTolerance)
                    << view.name << " at " << direction.pixel.x << ", " << direction.pixel.y << ", axis " << axis;
        }
    }
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
    EXPECT_NEAR(lens(50.0, 1.5), glm::degrees(2.0 * std::atan(36.0 / 100.0)), 1e-12);
}

TEST(CompiledCamera, SizeOverrideKeepsHorizontalFov) {
    CompileOptions options;
    options.size = glm::uvec2(64, 16);
    const shared::Camera camera = compileScene(scene(), options).constants.camera;
    const glm::dvec3 left = glm::normalize(glm::dvec3(camera.forward) + 8.0 * glm::dvec3(camera.dy));
    const glm::dvec3 right =
        glm::normalize(glm::dvec3(camera.forward) + 64.0 * glm::dvec3(camera.dx) + 8.0 * glm::dvec3(camera.dy));
    // Half a rounding for each of the nine floats.
    EXPECT_NEAR(glm::degrees(std::acos(glm::dot(left, right))), 40.0, 1e-4);
    EXPECT_GT(left.x, 0.0) << "+x is on the left";
}

TEST(CompiledCamera, SizeOverrideKeepsVerticalFovIfThatWasGiven) {
    SceneDescription description = scene();
    description.camera.fovAxis = FovAxis::Y;
    for (const glm::uvec2 size : {glm::uvec2(32, 32), glm::uvec2(64, 16), glm::uvec2(16, 64)}) {
        CompileOptions options;
        options.size = size;
        const shared::Camera camera = compileScene(description, options).constants.camera;
        const glm::dvec3 middle = glm::dvec3(camera.forward) + 0.5 * size.x * glm::dvec3(camera.dx);
        const glm::dvec3 top = glm::normalize(middle);
        const glm::dvec3 bottom = glm::normalize(middle + double(size.y) * glm::dvec3(camera.dy));
        EXPECT_NEAR(glm::degrees(std::acos(glm::dot(top, bottom))), 40.0, 1e-4) << size.x;
    }
}

TEST(CompiledCamera, RefusesScaleAndFlatFov) {
    SceneDescription scaled = scene();
    scaled.camera.toWorld = scaling({1, 2, 1});
    EXPECT_TRUE(contains(inputErrorOf(scaled), "without scale"));
    for (const double fov : {0.0, 180.0, -1.0, double(NAN)}) {
        SceneDescription wide = scene();
        wide.camera.fovDegrees = fov;
        EXPECT_TRUE(contains(inputErrorOf(wide), "(0, 180)")) << fov;
    }
}

TEST(CompiledFilm, ChecksSizeAndCrop) {
    CompileOptions options;
    options.size = glm::uvec2(0, 4);
    EXPECT_TRUE(contains(inputErrorOf(scene(), options), "[1, 65536]"));
    options.size = glm::uvec2(4, 65537);
    EXPECT_TRUE(contains(inputErrorOf(scene(), options), "[1, 65536]"));

    options.size = glm::uvec2(16, 8);
    options.cropOffset = glm::uvec2(10, 3);
    const CompiledScene rest = compileScene(scene(), options);
    EXPECT_EQ(rest.cropSize, glm::uvec2(6, 5));
    options.cropSize = glm::uvec2(7, 5);
    EXPECT_TRUE(contains(inputErrorOf(scene(), options), "crop"));
    options.cropOffset = glm::uvec2(0xffffffffu, 0);
    EXPECT_TRUE(contains(inputErrorOf(scene(), options), "crop"));
}

TEST(CompiledFilm, TakesCropFromTheScene) {
    SceneDescription description = scene();
    description.film.cropOffset = glm::uvec2(3, 4);
    description.film.cropSize = glm::uvec2(5, 6);
    const CompiledScene compiled = compileScene(description);
    EXPECT_EQ(compiled.cropOffset, glm::uvec2(3, 4));
    EXPECT_EQ(compiled.cropSize, glm::uvec2(5, 6));
    EXPECT_EQ(compiled.filmSize, glm::uvec2(32, 32));
}

TEST(CompiledIntegrator, KeepsDepthsAndTheirOverride) {
    SceneDescription description = scene();
    EXPECT_EQ(compileScene(description).constants.maxDepth, shared::kNone);
    description.integrator.maxDepth = 3;
    description.integrator.rouletteDepth = 7;
    EXPECT_EQ(compileScene(description).constants.maxDepth, 3u);
    EXPECT_EQ(compileScene(description).constants.rouletteDepth, 7u);
    CompileOptions options;
    options.maxDepth = 0;
    EXPECT_EQ(compileScene(description, options).constants.maxDepth, 0u);
    options.maxDepth = -2;
    EXPECT_TRUE(contains(inputErrorOf(description, options), "max_depth"));
}

}  // namespace
}  // namespace parhelion
