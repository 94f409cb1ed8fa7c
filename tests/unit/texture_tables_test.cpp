// (u, v) of shapes and texture lookups against the values that Mitsuba 3.9.1 has (tools/mitsuba/textures.py).
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "compile/compile_geometry.h"
#include "compile/compile_scene.h"
#include "image/image.h"
#include "reference/geometry/intersection.h"
#include "reference/surface/texture.h"
#include "support/paths.h"
#include "support/render_scene.h"
#include "support/scene_reading.h"

namespace parhelion::test {
namespace {

/// A row: scene text, then numbers.
struct Row {
    std::string text;
    std::vector<double> numbers;
};

/// @param count  rows that the table has.
std::vector<Row> rowsOf(const std::string& name, std::size_t count) {
    std::ifstream file(test::projectFolder() + "/tests/references/" + name);
    std::vector<Row> rows;
    std::string line, cell;
    std::getline(file, line);  // the header
    while (std::getline(file, line)) {
        std::istringstream cells(line);
        Row row;
        std::getline(cells, row.text, '|');
        while (std::getline(cells, cell, '|')) row.numbers.push_back(std::stod(cell));
        rows.push_back(row);
    }
    EXPECT_EQ(rows.size(), count) << name;
    return rows;
}

const std::map<std::string, std::string> kFiles = {
    {"with_uvs.obj", "v -2 -2 0.2\nv 2 -2 0\nv 0 3 -0.1\nvt 0.1 0.2\nvt 0.9 0.3\nvt 0.4 1.7\nf 1/1 2/2 3/3\n"},
    {"without_uvs.obj", "v -2 -2 0.2\nv 2 -2 0\nv 0 3 -0.1\nf 1 2 3\n"}};
const std::string kBsdf = R"(<bsdf type="diffuse"><texture type="checkerboard" name="reflectance"/></bsdf>)";

/// The shape, textured; `copies` of it, so that rectangles and cubes become triangles.
CompiledScene compileShape(const std::string& shape, int copies) {
    const std::string textured = std::string(shape).insert(shape.rfind("</shape>"), kBsdf);
    std::string body;
    for (int i = 0; i < copies; ++i) body += textured;
    return compileScene(readText(sceneOf(body), {}, kFiles), {});
}

// Mitsuba works in single precision: (u, v) within a few roundings of a hit at a distance of up to 5, which uv's slope
// of 1 a unit or (on a small sphere) 0.5 / 0.6 keeps; next to a pole of a sphere u is less certain.
void expectUvs(int copies) {
    for (const Row& row : rowsOf("surface_uvs.csv", 150)) {
        const CompiledScene scene = compileShape(row.text, copies);
        const reference::SceneView<double> view(scene);
        const std::vector<double>& n = row.numbers;
        reference::Ray<double> ray;
        ray.origin = glm::dvec3(n[0], n[1], n[2]) - scene.worldOrigin;
        ray.direction = glm::normalize(glm::dvec3(n[3], n[4], n[5]));
        const auto hit = reference::closestHit(view, ray);
        ASSERT_TRUE(hit.found()) << row.text;
        const glm::dvec2 uv = reference::surfaceAt(view, ray, hit).uv;
        const bool isSphere = row.text.find("sphere") != std::string::npos;
        const double byPole = isSphere ? 1 / std::sin(uv.y * 3.14159265) : 1;
        EXPECT_NEAR(uv.x, n[6], 4e-6 * byPole) << row.text;
        EXPECT_NEAR(uv.y, n[7], 4e-6 * byPole) << row.text;
    }
}

TEST(SurfaceCoordinates, AreMitsubasOnEveryShape) { expectUvs(1); }

TEST(SurfaceCoordinates, AreTheSameOnShapesCutIntoTriangles) { expectUvs(int(2 * kMaxFlatPrimitives)); }

TEST(TextureLookup, IsMitsubasForEveryWrapFilterAndTransform) {
    const TemporaryFolder folder;
    Image bitmap{.size = {3, 2}, .channels = {}, .attributes = {}};
    bitmap.channels["R"] = {1, 0, 0.25f, 0.5f, 0.125f, 0};
    bitmap.channels["G"] = {0, 1, 0.5f, 0.25f, 0, 0.75f};
    bitmap.channels["B"] = {0.5f, 0.25f, 0, 1, 0, 0.5f};
    writeExr(folder.path() / "bitmap.exr", bitmap);
    for (const Row& row : rowsOf("texture_values.csv", 204)) {
        std::string text = row.text;
        if (const auto name = text.find("$bitmap"); name != std::string::npos)
            text.replace(name, 7, (folder.path() / "bitmap.exr").string());
        const SceneDescription description =
            readText(sceneOf("<shape type=\"rectangle\"><bsdf type=\"diffuse\">" + text + "</bsdf></shape>"));
        const CompiledScene scene = compileScene(description, {});
        const glm::dvec2 uv(row.numbers[0], row.numbers[1]);
        const glm::dvec3 color = reference::reflectanceAt(scene, scene.shapes.at(0), uv);
        // Mitsuba's transformed coordinates, up to 12, are rounded to 2^-21; a texel is a third wide, its slope 1.
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(color[c], row.numbers[2 + c], 8e-6) << text << " at " << uv.x << ", " << uv.y;
    }
}

}  // namespace
}  // namespace parhelion::test
