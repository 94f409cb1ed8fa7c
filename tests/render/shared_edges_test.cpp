#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>
#include <string_view>

#include "support/hand_scene.h"
#include "support/rendering.h"
#include "support/scene_reading.h"
#include "support/stress.h"
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

/// A closed mesh about the origin, its faces outwards.
struct Room {
    const char* name;
    std::vector<glm::dvec3> vertices;
    std::vector<std::array<std::size_t, 3>> faces;
};

/// Adds a triangle, turned away from the origin.
void addFace(Room& room, std::size_t a, std::size_t b, std::size_t c) {
    const glm::dvec3 normal =
        glm::cross(room.vertices[b] - room.vertices[a], room.vertices[c] - room.vertices[a]);
    if (glm::dot(normal, room.vertices[a]) < 0) std::swap(b, c);
    room.faces.push_back({a, b, c});
}

/// A box whose sides are cut where the numbers say: cells next to each other that are very unlike.
Room box(const char* name, const std::vector<double>& cuts) {
    Room room{name, {}, {}};
    std::map<std::array<double, 3>, std::size_t> known;
    const auto vertex = [&](const glm::dvec3& at) {
        const auto [found, isNew] = known.try_emplace({at.x, at.y, at.z}, room.vertices.size());
        if (isNew) room.vertices.push_back(at);
        return found->second;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0})
            for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
                for (std::size_t j = 0; j + 1 < cuts.size(); ++j) {
                    const auto at = [&](std::size_t u, std::size_t v) {
                        glm::dvec3 p;
                        p[axis] = side;
                        p[(axis + 1) % 3] = cuts[u];
                        p[(axis + 2) % 3] = cuts[v];
                        return vertex(p);
                    };
                    addFace(room, at(i, j), at(i + 1, j), at(i + 1, j + 1));
                    addFace(room, at(i, j), at(i + 1, j + 1), at(i, j + 1));
                }
    return room;
}

/// A prism of thin slices; its lids are fans about one of their corners.
Room prism(std::size_t slices) {
    Room room{"prism", {}, {}};
    for (std::size_t i = 0; i < slices; ++i)
        for (const double y : {-1, 1}) {
            const double angle = 2 * glm::pi<double>() * double(i) / double(slices);
            room.vertices.emplace_back(std::cos(angle), y, std::sin(angle));
        }
    for (std::size_t i = 0; i < slices; ++i) {
        const std::size_t a = 2 * i, b = 2 * ((i + 1) % slices);
        addFace(room, a, b, b + 1);
        addFace(room, a, b + 1, a + 1);
        if (i == 0 || i + 1 == slices) continue;
        addFace(room, 0, a, b);
        addFace(room, 1, a + 1, b + 1);
    }
    return room;
}

/// A sphere of triangles, scaled along the axes and, vertex by vertex, by a factor within 1 give or take `relief`.
Room ball(const char* name, int subdivisions, const glm::dvec3& scale, double relief) {
    Room room{name, {}, {}};
    std::map<std::array<float, 3>, std::size_t> known;
    Stress stress(5);
    const std::vector<glm::vec3> corners = icosphere(subdivisions);
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        std::size_t face[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3& p = corners[i + k];
            const auto [found, isNew] = known.try_emplace({p.x, p.y, p.z}, room.vertices.size());
            if (isNew)
                room.vertices.push_back(glm::dvec3(p) * scale * (1 + relief * double(stress.between(-1, 1))));
            face[k] = found->second;
        }
        addFace(room, face[0], face[1], face[2]);
    }
    return room;
}

/// Two planes of 20 by 2 that meet at 3 degrees.
Room wedge() {
    Room room{"wedge", {}, {}};
    for (const double y : {-1, 1})
        for (const auto& [x, z] : {std::pair(-1.0, 0.01), {19.0, -0.5}, {19.0, 0.548}}) room.vertices.emplace_back(x, y, z);
    addFace(room, 0, 1, 2);
    addFace(room, 3, 4, 5);
    for (const auto& [a, b] : {std::pair(0u, 1u), {1u, 2u}, {2u, 0u}}) {
        addFace(room, a, b, b + 3);
        addFace(room, a, b + 3, a + 3);
    }
    return room;
}

std::vector<Room> rooms() {
    return {box("box", {-1, 1}),
            box("box of uneven cells", {-1, -0.99993, -0.6, 0.1, 0.1003, 0.9, 1}),
            prism(300),
            ball("sphere", 2, glm::dvec3(1), 0),
            ball("lens", 2, {1, 0.1, 1}, 0),
            ball("needle", 2, {1, 0.04, 0.03}, 0),
            ball("cave", 2, glm::dvec3(1), 0.3),
            ball("rough", 3, glm::dvec3(1), 0.01),
            wedge()};
}

/// The mesh, or six rectangles.
std::string shapesOf(const Room* room, const std::string& place, const TemporaryFolder& folder) {
    const std::string surface =
        R"(<bsdf type="twosided"><bsdf type="diffuse"><float name="reflectance" value="0.9"/></bsdf></bsdf></shape>)";
    std::string shapes;
    if (!room) {
        for (const char* turn : {"", R"(<rotate x="1" angle="180"/>)", R"(<rotate y="1" angle="90"/>)",
                                 R"(<rotate y="1" angle="-90"/>)", R"(<rotate x="1" angle="90"/>)",
                                 R"(<rotate x="1" angle="-90"/>)"})
            shapes += R"(<shape type="rectangle"><transform name="to_world"><translate z="-1"/>)" + (turn + place) +
                      "</transform>" + surface;
        return shapes;
    }
    std::string mesh;
    for (const glm::dvec3& v : room->vertices) mesh += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
    for (const auto& f : room->faces) mesh += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
    folder.write("room.obj", mesh);
    return R"(<shape type="obj"><string name="filename" value="room.obj"/><boolean name="face_normals" value="true"/>
        <transform name="to_world">)" +
           place + "</transform>" + surface;
}

/// A room under a white sky, seen from its middle: the camera looks at a point of it and sees 1e-5 degrees.
///
/// @param room  none: the cube from -1 to 1, of rectangles.
CompiledScene lookInto(const Room* room, double scale, const glm::dvec3& target) {
    const TemporaryFolder folder;
    const double c = std::cos(23 * kDegree), s = std::sin(23 * kDegree);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 0.4, 0.2));
    const glm::dvec3 at = scale * (target * c + glm::cross(axis, target) * s + axis * glm::dot(axis, target) * (1 - c));
    const std::string scene = fmt::format(
        R"(<scene version="3.0.0"><integrator type="volpath"><integer name="max_depth" value="12"/></integrator>
        <sensor type="perspective"><float name="fov" value="1e-5"/><transform name="to_world">
        <lookat origin="0, 0, 0" target="{}, {}, {}" up="0.1, 0.9, 0.3"/></transform><film type="hdrfilm">
        <integer name="width" value="4"/><integer name="height" value="4"/><rfilter type="box"/></film></sensor>
        <emitter type="constant"><float name="radiance" value="1"/></emitter>{}</scene>)",
        at.x, at.y, at.z,
        shapesOf(room, fmt::format(R"(<scale value="{}"/><rotate x="1" y="0.4" z="0.2" angle="23"/>)", scale), folder));
    return compileScene(readScene(folder.write("scene.xml", scene)));
}

// Into the corners and edges of closed rooms that a white sky surrounds: no path finds the sky.
TEST_P(SharedEdges, NothingLeavesAClosedRoomThroughThem) {
    const bool isDevice = GetParam() == Backend::Vulkan;  // compiles a kernel for each scene: two rooms
    Stress stress(6);
    for (const Room& room : rooms())
        for (const double scale : {1e-3, 1.0, 1e3}) {
            if (isDevice && (scale != 1.0 || std::string_view(room.name).find("cells") == std::string_view::npos)) continue;
            for (const double share : {0.0, 0.3, 0.5}) {
                const auto& face = room.faces[stress.word() % room.faces.size()];
                const glm::dvec3 target = glm::mix(room.vertices[face[0]], room.vertices[face[1]], share);
                const Film film = renderOn(GetParam(), lookInto(&room, scale, target), 256);
                EXPECT_EQ(imageMean(film).mean, 0) << room.name << ", size " << scale << ", " << share << " of an edge";
                EXPECT_EQ(countAnomalies(film), 0u);
            }
        }
}

// Nor a room of rectangles, whose corners agree but for rounding.
TEST_P(SharedEdges, NothingLeavesARoomOfRectangles) {
    const bool isDevice = GetParam() == Backend::Vulkan;
    for (const double scale : {1e-3, 1.0, 1e3})
        for (const glm::dvec3 target : {glm::dvec3(1, 1, 1), {1, 1, 0.3}, {1, 0.2, 1}, {-1, -1, 0.5}}) {
            if (isDevice && (scale != 1.0 || target.x != target.y)) continue;
            const Film film = renderOn(GetParam(), lookInto(nullptr, scale, target), 256);
            EXPECT_EQ(imageMean(film).mean, 0) << "size " << scale << ", at " << target.z;
            EXPECT_EQ(countAnomalies(film), 0u);
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
