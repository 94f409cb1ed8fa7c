// shaders/light/light.glsl against double precision, each type of light.
#include "reference/light/light.h"

#include <gtest/gtest.h>

#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/stress.h"
#include "support/words.h"

namespace parhelion {
namespace {

using test::ErrorMeter;
using test::Parity;
using test::Stress;

const char* const kShader = "parity/light.comp";
enum Function : std::uint32_t { kSample, kCone, kPdf, kCosine, kArea };

/// One light of each type; H71: from 1e-10 to 1e10 strong. Two-sided, the quad turns its back on the samples.
struct LitScene : test::HandScene {
    explicit LitScene(bool isTwoSided) {
        const auto shape = [this] { return addDiffuse(glm::vec3(0.5f)); };
        const std::uint32_t quad = shape(), ball = shape(), mesh = shape();
        const std::uint32_t quadId = addQuad({-1, 3, -1}, {2, 0, 0}, {0.2f, 0, 2}, quad);
        const std::uint32_t ballId = addSphere({4, 0.5f, -0.3f}, 0.7f, ball);
        std::vector<glm::vec3> vertices = test::icosphere(1);
        for (glm::vec3& v : vertices) v = glm::vec3(-4, 0.4f, 0) + v * glm::vec3(0.5f, 1, 0.7f);
        addTriangles(vertices, mesh);
        addAreaLight(shared::kLightQuad, quadId, quad, {1e10f, 1, 2});
        addAreaLight(shared::kLightSphere, ballId, ball, {1e-10f, 1, 3});
        addMeshLight(mesh, {1, 2, 3});
        for (std::uint32_t i = 0; i < 3 && isTwoSided; ++i) scene.constants.lights[i].flags |= shared::kLightTwoSided;
        if (isTwoSided) scene.constants.quads[0].normal = -scene.constants.quads[0].normal;
        shared::Light directional{};
        directional.type = shared::kLightDirectional;
        directional.vector = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
        directional.emission = {3, 2, 1};
        addLight(directional);
        shared::Light point{};
        point.type = shared::kLightPoint;
        point.vector = {0.5f, 2, 0.5f};
        point.emission = {1, 1e10f, 1};
        addLight(point);
        shared::Light environment{};
        environment.type = shared::kLightEnvironment;
        environment.emission = {0.5f, 0.6f, 0.7f};
        addLight(environment);
    }
};

class LightParity : public testing::TestWithParam<bool> {
protected:
    /// How the roundings of a position about the light grow in a direction and in 1 / cosine.
    struct Conditioning {
        double direction = 1, cosine = 1, distance = 1;
    };

    Conditioning conditioning(std::size_t light, const glm::dvec3& position,
                              const reference::LightSample<double>& sample) const {
        if (std::isinf(sample.distance)) return {};
        const double reach = glm::length(position) + 6;  // the lights are within 6 of the origin
        Conditioning c{1 + reach / sample.distance, 1, 1};
        const double solid = sample.pdf / scene_.lights[light].selection;
        if (scene_.lights[light].type == shared::kLightSphere) {
            const glm::dvec3 toCenter = scene_.spheres[0].center - position;
            const double half = glm::dot(toCenter, sample.direction) - sample.distance;
            const double sine2 = 0.49 / glm::dot(toCenter, toCenter);
            c.cosine = 1 + 1 / (1 - sine2);
            c.distance = 1 + reach / std::max(half, 1e-9);
        } else if (!sample.isDelta) {
            const double area = light == 0 ? scene_.quads[0].area : reference::meshArea(scene_, sample.target);
            c.cosine = 1 + solid * area / (sample.distance * sample.distance);  // 1 / cosine
        }
        return c;
    }

    LitScene built_{GetParam()};
    reference::SceneView<double> scene_{built_.scene};
};

/// Positions and words of a light draw.
std::vector<glm::vec4> samples() {
    std::vector<glm::vec4> inputs;
    Stress stress(28);
    const auto add = [&inputs](const glm::vec3& position, const glm::uvec3& words) {
        inputs.emplace_back(position, 0);
        inputs.emplace_back(glm::uintBitsToFloat(words), 0);
    };
    for (const float u : test::stressUniforms(20'000))
        add(stress.point(2.5f), {test::wordOf(u) + stress.word() % 256, stress.word(), stress.word()});
    add({4, 0.5f, -0.3f}, {1u << 30, 1u << 31, 0});  // in the middle of the sphere
    add({0.5f, 2, 0.5f}, {3u << 30, 1u << 31, 0});   // H65: at the point light
    return inputs;
}

TEST_P(LightParity, SampleAgreesForEveryLightH63H65H71) {
    const auto inputs = samples();
    const auto outputs = test::SceneProbe(built_.scene).run(kShader, kSample, inputs, 2, 3);
    Parity select("light/light", "selectLight", 0);
    // Warp and basis (10 + 11 in three components) or a point of an area (4) and its difference; normalisation 9.
    Parity direction("light/light", "sampleLight", 3 * 21 + 9);
    // Squares and quotients of these.
    Parity density("light/area_light", "sampleArea sampleSphereLight sampleMeshLight", 2 * (3 * 21 + 9));
    std::array<int, 6> compared{};
    for (std::size_t i = 0; i < inputs.size() / 2; ++i) {
        const glm::dvec3 position(inputs[2 * i]);
        const glm::uvec3 words = glm::floatBitsToUint(glm::vec3(inputs[2 * i + 1]));
        const glm::vec4 first = outputs[3 * i], second = outputs[3 * i + 1];
        const std::size_t light = reference::selectLight(scene_, reference::toUniform<double>(words.x));
        EXPECT_TRUE(select.equal(glm::floatBitsToUint(outputs[3 * i + 2].y), light)) << words.x;
        const auto sample = reference::sampleLight(scene_, position, words);
        if (!sample) {
            EXPECT_EQ(glm::vec3(second), glm::vec3(0)) << i;
            continue;
        }
        const Conditioning by = conditioning(light, position, *sample);
        if (by.cosine > 1e4 || by.distance > 1e4) continue;  // seen edge-on, or at the rim of the sphere
        ++compared[light];
        const double reach = sample->distance * by.direction * by.distance, scale = by.direction * by.cosine;
        EXPECT_TRUE(direction.near(first, sample->direction, by.direction)) << i;
        EXPECT_TRUE(direction.near(first.w, sample->distance, reach)) << i << ", light " << light;
        const double pdf = sample->isDelta ? double(INFINITY) : sample->pdf;
        EXPECT_TRUE(density.near(second.w, pdf, pdf * scale)) << i << ", light " << light;
        for (int c = 0; c < 3; ++c)
            EXPECT_TRUE(density.near(second[c], sample->radianceOverPdf[c], sample->radianceOverPdf[c] * scale)) << i;
        EXPECT_EQ(glm::floatBitsToUint(outputs[3 * i + 2].x), sample->target) << i;
    }
    for (const int count : compared) EXPECT_GT(count, 500);
}

// H62: spheres seen under the sun's angle and less.
TEST_P(LightParity, ConeOfADistantSphereKeepsItsDigitsH62) {
    constexpr double kAllowed = 24;  // squares and dot product 8, quotient 5, root and quotient 6 + 5
    std::vector<glm::vec4> inputs;
    Stress stress(29);
    for (int i = 0; i < 5'000; ++i)
        inputs.emplace_back(stress.direction() * stress.magnitude(1.1f, 1e6f), stress.magnitude(1e-3f, 1));
    const auto outputs = test::SceneProbe(built_.scene).run(kShader, kCone, inputs, 1, 1);
    Parity parity("light/area_light", "oneMinusCosCone", kAllowed);
    ErrorMeter naive;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const reference::Sphere<double> sphere{glm::dvec3(inputs[i]), inputs[i].w, 0, false};
        const double expected = *reference::oneMinusCosCone(sphere, glm::dvec3(0));
        EXPECT_TRUE(parity.near(outputs[i].x, expected)) << i;
        const glm::vec3 toCenter(inputs[i]);
        naive.add(1 - std::sqrt(1 - inputs[i].w * inputs[i].w / glm::dot(toCenter, toCenter)), expected);
    }
    EXPECT_GT(naive.worst(), 100 * kAllowed);
}

TEST_P(LightParity, CosineAgreesOnBothSides) {
    std::vector<glm::vec4> inputs;
    Stress stress(31);
    for (int i = 0; i < 3'000; ++i) {
        inputs.emplace_back(stress.direction(), i % 3);
        inputs.emplace_back(stress.direction(), 0);
        inputs.emplace_back(stress.direction(), 0);
    }
    const auto outputs = test::SceneProbe(built_.scene).run(kShader, kCosine, inputs, 3, 1);
    Parity parity("light/area_light", "lightCosine", 4);  // three products and two sums of terms below 1
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const auto& light = scene_.lights[std::size_t(inputs[3 * i].w)];
        const glm::dvec3 normal(inputs[3 * i]), outgoing(inputs[3 * i + 1]), shading(inputs[3 * i + 2]);
        if (std::abs(glm::dot(shading, outgoing)) < 4 * 0x1p-24) continue;  // the side is decided within rounding
        EXPECT_TRUE(parity.near(outputs[i].x, reference::lightCosine(light, normal, shading, outgoing), 1)) << i;
    }
}

TEST_P(LightParity, DensityOfALightMetByChanceAgrees) {
    std::vector<glm::vec4> inputs;
    Stress stress(30);
    for (int i = 0; i < 6'000; ++i) {
        inputs.emplace_back(stress.point(2.5f), 0);
        inputs.emplace_back(stress.magnitude(1e-3f, 1e3f), stress.magnitude(1e-3f, 1), i % 6, 0);
    }
    const auto outputs = test::SceneProbe(built_.scene).run(kShader, kPdf, inputs, 2, 1);
    // Products 4 and a quotient 5, or the cone 24 of a difference that the sphere's nearness magnifies, and a quotient.
    Parity parity("light/light", "lightPdf", 24 + 9);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const auto& light = scene_.lights[std::size_t(inputs[2 * i + 1].z)];
        const glm::dvec3 origin(inputs[2 * i]);
        const double distance = inputs[2 * i + 1].x, cosine = inputs[2 * i + 1].y;
        const glm::dvec3 direction(std::sqrt(1 - cosine * cosine), cosine, 0);
        const bool isDelta = light.type == shared::kLightDirectional || light.type == shared::kLightPoint;
        const double expected =
            isDelta ? 0 : reference::lightPdf(scene_, light, light.primitive, origin, direction, distance, cosine);
        EXPECT_TRUE(parity.near(outputs[i].x, expected, 4 * expected)) << i << ", type " << light.type;
    }
}

TEST_P(LightParity, AreasOfTrianglesAreTheTables) {
    std::vector<glm::vec4> inputs;
    for (std::uint32_t i = 0; i < built_.scene.constants.triangleCount; ++i) {
        inputs.emplace_back(0);
        inputs.emplace_back(scene_.firstTriangle + i, 0, 0, 0);
    }
    const auto outputs = test::SceneProbe(built_.scene).run(kShader, kArea, inputs, 2, 1);
    Parity parity("light/area_light", "meshArea", 0);
    for (std::uint32_t i = 0; i < outputs.size(); ++i)
        EXPECT_TRUE(parity.near(outputs[i].x, reference::meshArea(scene_, scene_.firstTriangle + i))) << i;
}

INSTANTIATE_TEST_SUITE_P(OneSideAndBoth, LightParity, testing::Bool(),
                         [](const auto& info) { return info.param ? "TwoSided" : "OneSided"; });

}  // namespace
}  // namespace parhelion
