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

// Rooms without a gap under a white sky, seen into their corners and edges: no path finds the sky.
namespace parhelion {
namespace {

using namespace test;

/// A closed mesh about the origin, its faces outwards.
struct Room {
    const char* name;
    std::vector<glm::dvec3> vertices;
    std::vector<std::array<std::size_t, 3>> faces;
};

/// Adds a triangle, turned away from the origin.
void addFace(Room& room, std::size_t a, std::size_t b, std::size_t c) {
    const glm::dvec3 normal = glm::cross(room.vertices[b] - room.vertices[a], room.vertices[c] - room.vertices[a]);
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
            if (isNew) room.vertices.push_back(glm::dvec3(p) * scale * (1 + relief * double(stress.between(-1, 1))));
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
        for (const auto& [x, z] : {std::pair(-1.0, 0.01), {19.0, -0.5}, {19.0, 0.548}})
            room.vertices.emplace_back(x, y, z);
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
        for (const char* turn :
             {"", R"(<rotate x="1" angle="180"/>)", R"(<rotate y="1" angle="90"/>)", R"(<rotate y="1" angle="-90"/>)",
              R"(<rotate x="1" angle="90"/>)", R"(<rotate x="1" angle="-90"/>)"})
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
    const double c = std::cos(23 * (glm::pi<double>() / 180)), s = std::sin(23 * (glm::pi<double>() / 180));
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

class ClosedRooms : public testing::TestWithParam<Backend> {};
INSTANTIATE_TEST_SUITE_P(Backends, ClosedRooms, testing::ValuesIn(kBackends),
                         [](const auto& info) { return std::string(name(info.param)); });

// Into the corners and edges of closed rooms that a white sky surrounds: no path finds the sky.
TEST_P(ClosedRooms, NothingLeavesThemThroughTheirEdges) {
    const bool isDevice = GetParam() == Backend::Vulkan;  // compiles a kernel for each scene: two rooms
    Stress stress(6);
    for (const Room& room : rooms())
        for (const double scale : {1e-3, 1.0, 1e3}) {
            if (isDevice && (scale != 1.0 || std::string_view(room.name).find("cells") == std::string_view::npos))
                continue;
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
TEST_P(ClosedRooms, NothingLeavesARoomOfRectangles) {
    const bool isDevice = GetParam() == Backend::Vulkan;
    for (const double scale : {1e-3, 1.0, 1e3})
        for (const glm::dvec3 target : {glm::dvec3(1, 1, 1), {1, 1, 0.3}, {1, 0.2, 1}, {-1, -1, 0.5}}) {
            if (isDevice && (scale != 1.0 || target.x != target.y)) continue;
            const Film film = renderOn(GetParam(), lookInto(nullptr, scale, target), 256);
            EXPECT_EQ(imageMean(film).mean, 0) << "size " << scale << ", at " << target.z;
            EXPECT_EQ(countAnomalies(film), 0u);
        }
}

}  // namespace
}  // namespace parhelion
