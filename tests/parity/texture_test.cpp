// shaders/surface/texture.glsl and the surface coordinates against double precision.
#include "reference/surface/texture.h"

#include <gtest/gtest.h>

#include "reference/light/area_light.h"
#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::Parity;
using test::Stress;

const char* const kShader = "parity/texture.comp";
enum Function : std::uint32_t { kLookup, kWrap, kSphere, kFlat };

/// A bitmap under every wrap and filter, one under a transform, a checkerboard; a ball, a box and triangles with (u,
/// v).
struct TexturedScene : test::HandScene {
    TexturedScene() {
        Stress stress(61);
        for (int i = 0; i < 7 * 5; ++i) scene.textureTexels.emplace_back(stress.point(0.5f) + 0.5f, 0);
        for (const std::uint32_t filter : {0u, shared::kTextureNearest})
            for (const std::uint32_t wrap : {0u, shared::kTextureClamp, shared::kTextureMirror})
                addTexture(filter | wrap, {1, 0}, {0, 1}, {0, 0});
        addTexture(0, {1.5f, 0.4f}, {-0.3f, 2.1f}, {0.3f, 0.7f});
        addTexture(shared::kTextureCheckerboard, {3, 0.5f}, {-0.25f, 4}, {0.125f, 0.5f});
        const std::uint32_t shape = addDiffuse(glm::vec3(0.5f));
        addSphere({0, 0, -3}, 1, shape);
        scene.constants.spheres[0].axisX = glm::normalize(glm::vec3(1, 2, -0.5f));
        scene.constants.spheres[0].axisZ = glm::normalize(glm::vec3(-2, 1, 0));
        scene.constants.spheres[0].handedness = -1;
        addBox({-0.6f, -0.7f, -0.4f}, {0.7f, 0.5f, 0.6f}, shape);
        addTriangles(test::icosphere(0), shape);
        for (std::uint32_t i = 0; i < 3 * scene.constants.triangleCount; ++i)
            scene.triangleUvs.emplace_back(stress.between(-1, 2), stress.between(-1, 2));
        shared::Light light{};
        light.type = shared::kLightSphere;
        light.emission = {3, 2, 5};
        addLight(light);
    }
    void addTexture(std::uint32_t flags, glm::vec2 u, glm::vec2 v, glm::vec2 translation) {
        shared::Texture texture{};
        texture.flags = flags;
        texture.size = {7, 5};
        texture.transformU = u;
        texture.transformV = v;
        texture.translation = translation;
        texture.color0 = {0.9f, 0.5f, 0.1f};
        texture.color1 = {0.2f, 0.3f, 0.4f};
        scene.textures.push_back(texture);
    }
};

glm::vec4 withIndex(glm::vec3 v, std::uint32_t index) { return {v, glm::uintBitsToFloat(index)}; }

class TextureParity : public testing::Test {
protected:
    std::vector<glm::vec4> run(Function function, const std::vector<glm::vec4>& inputs, std::uint32_t outputs) const {
        return test::SceneProbe(built_.scene).run(kShader, function, inputs, 1, outputs);
    }

    TexturedScene built_;
    reference::SceneView<double> view_{built_.scene};
};

/// How far a transformed coordinate in texels (of a checkerboard: in halves) is from where the colour jumps.
double distanceFromJump(const shared::Texture& texture, const glm::dvec2& uv) {
    const glm::dvec2 p =
        uv.x * glm::dvec2(texture.transformU) + uv.y * glm::dvec2(texture.transformV) + glm::dvec2(texture.translation);
    const bool isChecker = texture.flags & shared::kTextureCheckerboard;
    const glm::dvec2 count = p * (isChecker ? glm::dvec2(2) : glm::dvec2(texture.size));
    const glm::dvec2 d = glm::abs(count - glm::round(count));
    return std::min(d.x, d.y);
}

TEST_F(TextureParity, LookupsAgreeForEveryWrapAndFilter) {
    std::vector<glm::vec4> inputs;
    Stress stress(62);
    for (std::uint32_t index = 0; index < built_.scene.textures.size(); ++index)
        for (int i = 0; i < 3'000; ++i)
            inputs.push_back(withIndex(stress.point(i % 3 == 0 ? 0.5f : 4.0f) + (i % 3 == 0 ? 0.5f : 0.0f), index));
    inputs.push_back(withIndex(glm::vec3(0.3f), shared::kNone));
    const auto outputs = run(kLookup, inputs, 3);
    // In units of the coordinate's size, at most 25: transform 5, wrap 1, times the texels 1, each over 7 texels across
    // which the colour may change by 1 a texel; the weights of four corners 6.
    constexpr double kAllowed = 7 * 7 + 6;
    Parity lookup("surface/texture", "textureAt bitmapAt checkerboardAt", kAllowed);
    Parity reflectance("surface/texture", "reflectanceAt", kAllowed + 1);
    Parity emission("light/area_light", "emissionAt", kAllowed + 1);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const std::uint32_t index = glm::floatBitsToUint(inputs[i].w);
        const glm::dvec2 uv(inputs[i]);
        const double scale = 1 + 4 * (std::abs(uv.x) + std::abs(uv.y));
        if (index != shared::kNone) {
            const shared::Texture& texture = built_.scene.textures[index];
            const bool jumps = texture.flags & (shared::kTextureCheckerboard | shared::kTextureNearest);
            if (jumps && distanceFromJump(texture, uv) < kAllowed * test::kRounding * scale) continue;
        }
        ++compared;
        const glm::dvec3 expected = reference::textureAt(built_.scene, index, uv);
        EXPECT_TRUE(lookup.near(outputs[3 * i], expected, scale)) << index << " at " << uv.x << ", " << uv.y;
        EXPECT_TRUE(reflectance.near(outputs[3 * i + 1], expected * glm::dvec3(0.5, 0.25, 0.75), scale)) << i;
        EXPECT_TRUE(emission.near(outputs[3 * i + 2], expected * glm::dvec3(3, 2, 5), 5 * scale)) << i;
    }
    EXPECT_GT(compared, inputs.size() - 20);
}

// H72, H73: the ends are exact texels, and whatever the coordinate, a texel is what comes out.
TEST_F(TextureParity, CoordinatesWrapExactlyH72H73) {
    const std::vector<float> hard{0,     1,          -1e-9f,  -1e-38f, 0x1.fffffep-1f, 2,         -2,  1e7f,
                                  -1e7f, 16777217.f, 1.5e38f, -3e38f,  INFINITY,       -INFINITY, NAN, 0.5f};
    std::vector<glm::vec4> inputs;
    for (const std::uint32_t flags : {0u, shared::kTextureClamp, shared::kTextureMirror})
        for (const float x : hard)
            for (int i = -1; i <= 14; ++i) inputs.push_back(withIndex({x, float(i), 7}, flags));
    const auto outputs = run(kWrap, inputs, 1);
    Parity coordinate("surface/texture", "wrapCoordinate", 1), texel("surface/texture", "wrapTexel", 0);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const std::uint32_t flags = glm::floatBitsToUint(inputs[i].w);
        if (std::isfinite(inputs[i].x) && std::abs(inputs[i].x) < 1e8f) {
            EXPECT_TRUE(coordinate.near(outputs[i].x, reference::wrapCoordinate<double>(inputs[i].x, flags), 1)) << i;
        }
        // Beyond the first period (7 texels, mirrored 14) and its neighbours the shader promises a texel, not which.
        if (inputs[i].y <= ((flags & shared::kTextureMirror) ? 14 : 7)) {
            const int expected = reference::wrapTexel(int(inputs[i].y), 7, flags);
            EXPECT_TRUE(texel.equal(std::uint64_t(outputs[i].y), std::uint64_t(expected))) << i;
        }
        EXPECT_GE(outputs[i].y, 0);
        EXPECT_LT(outputs[i].y, 7);
    }
}

TEST_F(TextureParity, LookupsOfHardCoordinatesAreTexelsH72H73) {
    std::vector<glm::vec4> inputs;
    for (std::uint32_t index = 0; index < 6; ++index)
        for (const float x : {0.0f, 1.0f, -1e-9f, 1e7f, -1e7f, 3e38f, -3e38f, INFINITY, NAN})
            inputs.push_back(withIndex({x, 0.5f, 0}, index));
    const auto outputs = run(kLookup, inputs, 3);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::vec3 color(outputs[3 * i]);
        if (std::abs(inputs[i].x) <= 1e7f) {
            EXPECT_TRUE(glm::all(glm::lessThanEqual(glm::abs(color - 0.5f), glm::vec3(0.5f)))) << i;
        }
    }
    const auto texelAt = [&](unsigned column) { return glm::vec3(built_.scene.textureTexels[2 * 7 + column]); };
    const auto nearest = [&](int wrap, int hard) { return glm::vec3(outputs[3 * ((3 + wrap) * 9 + hard)]); };
    EXPECT_EQ(nearest(0, 1), texelAt(0));  // repeat: 1 is 0, and just below 0 is the last texel
    EXPECT_EQ(nearest(0, 2), texelAt(6));
    EXPECT_EQ(nearest(1, 1), texelAt(6));  // clamp
    EXPECT_EQ(nearest(1, 2), texelAt(0));
    EXPECT_EQ(nearest(2, 1), texelAt(6));  // mirror
    EXPECT_EQ(nearest(2, 2), texelAt(0));
}

TEST_F(TextureParity, CoordinatesOfSpheresAgreeToThePoles) {
    std::vector<glm::vec4> inputs;
    const glm::vec3 pole = built_.scene.constants.spheres[0].axisZ;
    Stress stress(63);
    for (const glm::vec3& n : test::stressDirections(3'000)) inputs.emplace_back(n, 0);
    for (int i = 0; i < 500; ++i)
        inputs.emplace_back(glm::normalize(pole + stress.direction() * stress.magnitude(1e-6f, 0.1f)), 0);
    const auto outputs = run(kSphere, inputs, 1);
    // Three products each of x, y and z: 5, the axis y 4 more; angle 6.
    Parity coordinates("geometry/surface", "sphereUv", 5 + 4 + 6), angle("core/math", "angleOf", 8);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::dvec2 uv = reference::sphereUv(view_.spheres[0], glm::dvec3(inputs[i]));
        const double ring = std::sin(uv.y * reference::kPi<double>);
        const double turn = std::abs(outputs[i].x - uv.x);
        // Where u starts anew, 0 and 1 are the same.
        if (ring > 1e-5) {
            EXPECT_TRUE(coordinates.near(std::min(turn, 1 - turn), 0, 1 / ring)) << i;
        }
        EXPECT_TRUE(coordinates.near(outputs[i].y, uv.y, 1)) << i;
        EXPECT_TRUE(angle.near(outputs[i].z, reference::angleOf<double>(inputs[i].y, inputs[i].x))) << i;
    }
}

TEST_F(TextureParity, CoordinatesOfBoxesAndTrianglesAgree) {
    std::vector<glm::vec4> inputs;
    Stress stress(64);
    for (int i = 0; i < 3'000; ++i)
        inputs.push_back(withIndex({stress.between(0, 0.5f), stress.between(0, 0.5f), stress.between(-0.3f, 0.5f)},
                                   unsigned(i % 20)));
    const auto outputs = run(kFlat, inputs, 1);
    Parity box("geometry/surface", "boxUv", 8), triangle("geometry/surface", "triangleUv", 2 * 8);
    int atEdges = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::dvec3 p(inputs[i]);
        const glm::dvec3 a = glm::abs(view_.boxes[0].localFromWorld.point(p));
        const bool atEdge = std::min({std::abs(a.x - a.y), std::abs(a.y - a.z), std::abs(a.x - a.z)}) < 1e-5;
        atEdges += atEdge;
        const glm::dvec2 uv = reference::boxUv(view_.boxes[0], p);
        if (!atEdge) {
            EXPECT_TRUE(box.near(glm::dvec3(outputs[i].x, outputs[i].y, 0), glm::dvec3(uv, 0), 2)) << i;
        }
        const glm::dvec2 t = reference::triangleUv(view_, unsigned(i % 20), glm::dvec2(p));
        EXPECT_TRUE(triangle.near(glm::dvec3(outputs[i].z, outputs[i].w, 0), glm::dvec3(t, 0), 2)) << i;
    }
    EXPECT_LT(atEdges, 10);
}

}  // namespace
}  // namespace parhelion
