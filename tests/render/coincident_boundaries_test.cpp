#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/rendering.h"
#include "support/scene_reading.h"
#include "support/temporary_folder.h"

// Boundaries of media whose faces coincide, with each other and with opaque ones: each counts once, in whatever order
// rounding lets a ray meet them. Light falls through absorbing media onto a wall; a shadow ray attenuates it without
// random numbers, so that every pixel is exact.
namespace parhelion {
namespace {

using namespace test;

/// A closed box as triangles. `variant` turns the order of corners and the diagonals, so that the same face is met at
/// other roundings of its distance.
std::string box(double bottom, double top, double half, int variant, int firstVertex = 1) {
    std::string text;
    for (int i = 0; i < 8; ++i)
        text += fmt::format("v {} {} {}\n", i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? top : bottom);
    static constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& face : kFaces) {
        const auto corner = [&](int i) { return firstVertex + face[(i + variant) % 4]; };
        text +=
            fmt::format("f {} {} {}\nf {} {} {}\n", corner(0), corner(1), corner(2), corner(0), corner(2), corner(3));
    }
    return text;
}

struct Layer {
    std::string mesh;  ///< OBJ
    double sigma;
    int exterior = -1;  ///< the layer around this one
};

struct Stack {
    const char* name;
    std::vector<Layer> layers;
    double depth;  ///< optical, straight through
    std::string shapes = "";
};

std::vector<Stack> stacks() {
    std::vector<Stack> all;
    for (int variant = 0; variant < 4; ++variant) {
        all.push_back({"three on top of each other",
                       {{box(1, 1.3, 1, 0), 1}, {box(1.3, 1.7, 1, variant), 2}, {box(1.7, 2.3, 1, 3 - variant), 3}},
                       0.3 + 0.8 + 1.8});
        all.push_back({"nested with common ends",
                       {{box(1, 2, 1, variant), 1}, {box(1, 2, 0.8, 1), 3, 0}, {box(1, 1.6, 0.7, 2), 0.5, 1}},
                       0.6 * 0.5 + 0.4 * 3});
        all.push_back({"neighbours within another",
                       {{box(1, 2, 1, variant), 0.25}, {box(1, 1.4, 1, 0), 2, 0}, {box(1.4, 2, 1, variant), 1, 0}},
                       0.4 * 2 + 0.6});
    }
    all.push_back({"two parts of one mesh that touch", {{box(1, 1.3, 1, 0) + box(1.3, 2, 1, 1, 9), 1.5}}, 1.5});
    all.push_back({"eight thin ones", {}, 0});
    for (int i = 0; i < 8; ++i) {
        all.back().layers.push_back({box(1 + 0.1 * i, 1.1 + 0.1 * i, 1, i % 4), 1.0 + i});
        all.back().depth += 0.1 * (1 + i);
    }
    return all;
}

CompiledScene lit(const Stack& stack, double scale) {
    const TemporaryFolder folder;
    std::string media, shapes;
    for (std::size_t i = 0; i < stack.layers.size(); ++i) {
        const Layer& layer = stack.layers[i];
        media += fmt::format(R"(<medium type="homogeneous" id="m{}"><float name="sigma_t" value="{}"/>
            <float name="albedo" value="0"/></medium>)",
                             i, layer.sigma / scale);
        folder.write(fmt::format("{}.obj", i), layer.mesh);
        shapes += fmt::format(
            R"(<shape type="obj"><string name="filename" value="{}.obj"/><boolean name="face_normals" value="true"/>
            <transform name="to_world"><scale value="{}"/></transform><bsdf type="null"/>
            <ref name="interior" id="m{}"/>{}</shape>)",
            i, scale, i,
            layer.exterior < 0 ? std::string() : fmt::format(R"(<ref name="exterior" id="m{}"/>)", layer.exterior));
    }
    const std::string scene = fmt::format(
        R"(<scene version="3.0.0"><integrator type="volpath"/><sensor type="perspective"><float name="fov" value="50"/>
        <transform name="to_world"><lookat origin="0, 0, {0}" target="0, 0, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="9"/><integer name="height" value="9"/><rfilter type="box"/></film>
        </sensor><emitter type="directional"><vector name="direction" x="0" y="0" z="-1"/>
        <float name="irradiance" value="1"/></emitter>{1}{2}<shape type="rectangle"><transform name="to_world">
        <scale value="{3}"/></transform><bsdf type="diffuse"><float name="reflectance" value="1"/></bsdf></shape></scene>)",
        0.9 * scale, media, shapes, 5 * scale);
    return compileScene(readScene(folder.write("scene.xml", scene)));
}

class CoincidentBoundaries : public testing::TestWithParam<Backend> {};
INSTANTIATE_TEST_SUITE_P(Backends, CoincidentBoundaries, testing::ValuesIn(kBackends),
                         [](const auto& info) { return std::string(name(info.param)); });

TEST_P(CoincidentBoundaries, EachCountsOnce) {
    std::size_t index = 0;
    for (const Stack& stack : stacks())
        for (const double scale : {1.0, 37.0}) {
            // The device compiles a kernel for each scene: a third of them do.
            if (GetParam() == Backend::Vulkan && ++index % 3 != 1) continue;
            const CompiledScene scene = lit(stack, scale);
            const Film film = renderOn(GetParam(), scene, 16);
            const double expected = std::exp(-stack.depth) / 3.14159265358979;
            for (std::size_t i = 0; i < film.pixels.size(); ++i) {
                // Depths of up to 3 in float, of distances with some roundings each: 1e-5 is 20 times that.
                const double mean = test::estimate(film.pixels[i], 16).mean;
                EXPECT_NEAR(mean, expected, 1e-5 * expected) << stack.name << ", size " << scale << ", pixel " << i;
            }
            EXPECT_EQ(countAnomalies(film), 0u);
        }
}

// Sixty spheres within each other, too many for any fixed depth; every other one is empty.
TEST_P(CoincidentBoundaries, NestingMayBeDeep) {
    std::string text = R"(<scene version="3.0.0"><integrator type="volpath"/><sensor type="perspective">
        <float name="fov" value="20"/><transform name="to_world"><lookat origin="0, 0, 90" target="0, 0, 0" up="0, 1, 0"/>
        </transform><film type="hdrfilm"><integer name="width" value="3"/><integer name="height" value="3"/>
        <rfilter type="box"/></film></sensor><emitter type="constant"/>)";
    for (const int i : {0, 1})
        text += fmt::format(R"(<medium type="homogeneous" id="m{}"><float name="sigma_t" value="{}"/>
            <float name="albedo" value="1"/></medium>)",
                            i, 0.01 + 0.02 * i);
    for (int i = 0; i < 60; ++i)
        text += fmt::format(R"(<shape type="sphere"><float name="radius" value="{}"/><bsdf type="null"/>
            <ref name="interior" id="m{}"/>{}</shape>)",
                            61 - i, i % 2,
                            i == 0 ? std::string() : fmt::format(R"(<ref name="exterior" id="m{}"/>)", 1 - i % 2));
    const TemporaryFolder folder;
    const CompiledScene scene = compileScene(readScene(folder.write("scene.xml", text + "</scene>")));
    // A white furnace: 1 in every pixel, but for rounding of a path's few factors.
    const Film film = renderOn(GetParam(), scene, 64);
    for (const shared::FilmPixel& pixel : film.pixels) EXPECT_NEAR(test::estimate(pixel, 64).mean, 1, 1e-5);
    EXPECT_EQ(countAnomalies(film), 0u);
}

}  // namespace
}  // namespace parhelion
