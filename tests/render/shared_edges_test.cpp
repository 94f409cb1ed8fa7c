#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "support/rendering.h"
#include "support/scene_reading.h"
#include "support/temporary_folder.h"

// Rays that leave from an edge or a corner that several faces share: whichever of them the vertex belongs to, the
// others lie at its start within rounding. Every camera ray goes to the edge itself.
namespace parhelion {
namespace {

using namespace test;

/// A mesh in its own frame, where the camera looks down -y at the origin.
struct Fold {
    const char* name;
    std::string vertices, faces;
    double visible;  ///< share of a white sky that lights the origin, directly
    bool asRectangles = false;
};

std::string wedge(double left, double right, double reach, double height) {
    // Two faces that meet in the z axis, at these angles from the horizontal.
    const auto corner = [&](double side, double angle, double z) {
        return fmt::format("v {} {} {}\n", side * reach * std::cos(angle), reach * std::sin(angle), z);
    };
    return fmt::format("v 0 0 {0}\nv 0 0 {1}\n", -height, height) + corner(-1, left, height) +
           corner(-1, left, -height) + corner(1, right, height) + corner(1, right, -height);
}

std::string fan(int count, double tilt) {
    std::string text = "v 0 0 0\n";
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * glm::pi<double>() * i / count + 0.1;
        text += fmt::format("v {} {} {}\n", 3 * std::cos(angle), tilt * 3, 3 * std::sin(angle));
    }
    return text;
}

std::string fanFaces(int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += fmt::format("f 1 {} {}\n", 2 + (i + 1) % count, 2 + i);
    return text;
}

const std::string kTwoFaces = "f 1 2 3\nf 1 3 4\nf 2 1 6\nf 2 6 5\n";
constexpr double kDegree = glm::pi<double>() / 180;

/// Next to an edge, within the wedge of angle t between two faces, a cosine-weighted share (1 - cos t) / 2 of the sky
/// is seen past the other face; folded away, all of the half-space is.
double seenInWedge(double degrees) { return degrees >= 180 ? 1 : (1 - std::cos(degrees * kDegree)) / 2; }

std::vector<Fold> folds() {
    return {
        {"in one plane", wedge(0, 0, 10, 7), kTwoFaces, 1},
        {"a floor of two triangles", "v -10 0 -10\nv -10 0 10\nv 10 0 10\nv 10 0 -10\n", "f 1 2 3\nf 1 3 4\n", 1},
        {"rectangles in one plane", "", "", 1, true},
        {"a ridge", wedge(-30 * kDegree, -40 * kDegree, 5, 7), kTwoFaces, 1},
        {"a valley", wedge(45 * kDegree, 45 * kDegree, 5, 7), kTwoFaces, seenInWedge(90)},
        {"a flat valley", wedge(5 * kDegree, 5 * kDegree, 5, 7), kTwoFaces, seenInWedge(170)},
        {"a fan", fan(9, 0), fanFaces(9), 1},
        {"a fan of many", fan(200, 0), fanFaces(200), 1},
        {"a hat", fan(7, -0.5), fanFaces(7), 1},
        {"slivers", wedge(0, 0, 5e-3, 30), kTwoFaces, 1},
        {"slivers side by side", wedge(-20 * kDegree, -20 * kDegree, 1e-2, 30), kTwoFaces, 1},
    };
}

/// Where a fold is put: a turn, a size and a place.
struct Place {
    double angle, scale, distance;
};

CompiledScene lookAt(const Fold& fold, const Place& place) {
    const TemporaryFolder folder;
    folder.write("fold.obj", fold.vertices + fold.faces);
    const std::string transform = fmt::format(
        R"(<transform name="to_world">{{}}<scale value="{}"/><rotate x="0.3" y="0.2" z="1" angle="{}"/></transform>)",
        place.scale, place.angle);
    const std::string surface = R"(<bsdf type="twosided"><bsdf type="diffuse"><float name="reflectance" value="0.5"/>
        </bsdf></bsdf></shape>)";
    std::string shapes;
    if (fold.asRectangles)
        for (const double x : {-1, 1})
            shapes += R"(<shape type="rectangle">)" +
                      fmt::format(fmt::runtime(transform),
                                  fmt::format(R"(<rotate x="1" angle="-90"/><translate x="{}"/>)", x)) +
                      surface;
    else
        shapes =
            R"(<shape type="obj"><string name="filename" value="fold.obj"/><boolean name="face_normals" value="true"/>)" +
            fmt::format(fmt::runtime(transform), "") + surface;
    // The camera stands along the turned y axis and sees a millionth of a degree.
    glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, 0.2, 1)), up(0, 1, 0), along(0, 0, 1);
    const double c = std::cos(place.angle * kDegree), s = std::sin(place.angle * kDegree);
    const auto turn = [&](glm::dvec3 v) {
        return v * c + glm::cross(axis, v) * s + axis * glm::dot(axis, v) * (1 - c);
    };
    const glm::dvec3 eye = turn(up) * place.distance, side = turn(along);
    const std::string scene = fmt::format(
        R"(<scene version="3.0.0"><integrator type="volpath"><integer name="max_depth" value="2"/></integrator>
        <sensor type="perspective"><float name="fov" value="1e-6"/><transform name="to_world">
        <lookat origin="{}, {}, {}" target="0, 0, 0" up="{}, {}, {}"/></transform><film type="hdrfilm">
        <integer name="width" value="4"/><integer name="height" value="4"/><rfilter type="box"/></film></sensor>
        <emitter type="constant"><float name="radiance" value="1"/></emitter>{}</scene>)",
        eye.x, eye.y, eye.z, side.x, side.y, side.z, shapes);
    return compileScene(readScene(folder.write("scene.xml", scene)));
}

class SharedEdges : public testing::TestWithParam<Backend> {};
INSTANTIATE_TEST_SUITE_P(Backends, SharedEdges, testing::ValuesIn(kBackends),
                         [](const auto& info) { return std::string(name(info.param)); });

// Without occlusion every path brings exactly .5; else a share of them does, binomially.
TEST_P(SharedEdges, VerticesOnThemSeeTheirShareOfTheSky) {
    constexpr std::uint64_t kSamples = 512;
    for (const Fold& fold : folds()) {
        // The device compiles a kernel for each scene, and decides as the reference does (IntersectionParity): some do.
        const bool isFew = GetParam() == Backend::Vulkan;
        if (isFew && fold.name != std::string("in one plane") && fold.name != std::string("a valley")) continue;
        for (const Place& place : {Place{0, 1, 0.01}, Place{0, 1, 3}, Place{37, 1, 0.3}, Place{37, 1e-4, 1e-5},
                                   Place{11, 1e4, 2e3}, Place{64, 1, 500}}) {
            if (isFew && place.angle != 37) continue;
            const CompiledScene scene = lookAt(fold, place);
            const Film film = renderOn(GetParam(), scene, kSamples);
            const double paths = double(kSamples) * double(film.pixels.size());
            const double error = 0.5 * std::sqrt(fold.visible * (1 - fold.visible) / paths);
            const PixelEstimate mean = imageMean(film);
            // From a distance some rays pass the edge by their own rounding: the same on both faces.
            EXPECT_NEAR(mean.mean, 0.5 * fold.visible, 6 * error + 2 * 0.5 / paths)
                << fold.name << ", turned " << place.angle << ", size " << place.scale << ", from " << place.distance;
            EXPECT_EQ(countAnomalies(film), 0u);
        }
    }
}

// What is small against its distance and in the way of rays that leave from next to an edge is met as elsewhere.
TEST_P(SharedEdges, SmallTrianglesFarAwayShade) {
    const TemporaryFolder folder;
    std::string mesh;
    constexpr int kCells = 20;
    for (int i = 0; i <= kCells; ++i)
        for (int j = 0; j <= kCells; ++j) mesh += fmt::format("v {} 5 {}\n", 0.9 + 0.01 * i, 0.01 * j - 0.1);
    for (int i = 0; i < kCells; ++i)
        for (int j = 0; j < kCells; ++j) {
            const int a = i * (kCells + 1) + j + 1, b = a + kCells + 1;
            mesh += fmt::format("f {} {} {}\nf {} {} {}\n", a, a + 1, b + 1, a, b + 1, b);
        }
    folder.write("patch.obj", mesh);
    const CompiledScene scene = compileScene(readScene(folder.write("scene.xml", R"(<scene version="3.0.0">
        <integrator type="volpath"><integer name="max_depth" value="2"/></integrator>
        <sensor type="perspective"><float name="fov" value="0.01"/><transform name="to_world">
        <lookat origin="0.5, 1, 0" target="0.9998, 0, 0.003" up="0, 0, 1"/></transform><film type="hdrfilm">
        <integer name="width" value="4"/><integer name="height" value="4"/><rfilter type="box"/></film></sensor>
        <emitter type="directional"><vector name="direction" x="0" y="-1" z="0"/></emitter>
        <shape type="obj"><string name="filename" value="patch.obj"/></shape>
        <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/></transform></shape></scene>)")));
    EXPECT_EQ(imageMean(renderOn(GetParam(), scene, 256)).mean, 0);
}

}  // namespace
}  // namespace parhelion
