// shaders/geometry/primitives.glsl against double precision.
#include "reference/geometry/primitives.h"

#include <gtest/gtest.h>

#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::kRounding;
using test::Parity;
using test::Stress;

const char* const kShader = "parity/primitives.comp";
enum Function : std::uint32_t { kQuad, kSphere, kBox };

struct Line {
    glm::vec3 origin, direction;
    std::uint32_t primitive = 0;  ///< within its kind
};

struct PrimitiveScene : test::HandScene {
    PrimitiveScene() {
        const std::uint32_t shape = addDiffuse(glm::vec3(0.5f));
        addQuad({-1, -1, 0.5f}, {2, 0, 0}, {0.3f, 1.5f, 0.4f}, shape);
        addQuad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, shape);
        addSphere({0.3f, -0.2f, 0.1f}, 0.8f, shape);
        addSphere({0, 0, 3e4f}, 1.0f, shape);  // H42: far away
        addBox({-1, -1, -1}, {1, 1, 1}, shape);
        addBox({-0.3f, 0.1f, 5}, {0.4f, 0.2f, 30}, shape);
    }
};

class PrimitivesParity : public testing::Test {
protected:
    std::vector<glm::vec4> run(Function function, const std::vector<Line>& lines) const {
        std::vector<glm::vec4> inputs;
        for (const Line& line : lines) {
            inputs.emplace_back(line.origin, glm::uintBitsToFloat(line.primitive));
            inputs.emplace_back(line.direction, 0);
        }
        return test::SceneProbe(built_.scene).run(kShader, function, inputs, 2, 1);
    }

    /// quadDistanceError counts in roundings of its precision.
    double errorBoundInFloat(const Line& line) const {
        const shared::Quad& record = built_.scene.constants.quads[line.primitive];
        reference::Quad<float> quad;
        quad.normal = record.normal;
        quad.corner = record.corner;
        return reference::quadDistanceError(quad, line.origin, line.direction, 0.0f);
    }

    PrimitiveScene built_;
    reference::SceneView<double> scene_{built_.scene};
};

TEST_F(PrimitivesParity, QuadDistanceAgreesWithinItsConditioning) {
    std::vector<Line> lines;
    Stress stress(14);
    for (int i = 0; i < 20'000; ++i) {
        const std::uint32_t which = stress.word() % 2;
        const auto& quad = scene_.quads[which];
        const glm::vec3 target(quad.corner + quad.edgeU * double(stress.between(-0.2f, 1.2f)) +
                               quad.edgeV * double(stress.between(-0.2f, 1.2f)));
        const glm::vec3 origin = stress.point(3);
        lines.push_back({origin, glm::normalize(target - origin), which});
    }
    for (const glm::vec3& d : test::stressDirections()) lines.push_back({{0.1f, 0, 0.3f}, d, 1});  // H40: in the plane
    const auto outputs = run(kQuad, lines);
    // Two dot products of differences 2 * (1 + 3), quotient 5; u and v take t and another dot product 3 + 2.
    constexpr double kDistance = 13, kEdge = kDistance + 5;
    // The bound: a dot product of a difference 4, the cosine 3 (relative to facing), two products.
    Parity parity("geometry/primitives", "intersectQuad", kDistance),
        bound("geometry/primitives", "quadDistanceError", 9);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto& quad = scene_.quads[lines[i].primitive];
        const glm::dvec3 o(lines[i].origin), d(lines[i].direction);
        const double facing = std::abs(glm::dot(quad.normal, d)), reach = glm::length(quad.corner - o);
        if (facing < 1e-3) {
            EXPECT_FALSE(std::isnan(outputs[i].x)) << i;
            continue;
        }
        const double scale = reach / (facing * facing);
        const glm::dvec3 p = o + d * (glm::dot(quad.normal, quad.corner - o) / glm::dot(quad.normal, d)) - quad.corner;
        const double u = glm::dot(quad.uFromWorld, p), v = glm::dot(quad.vFromWorld, p);
        const double edge = std::min({std::abs(u), std::abs(v), std::abs(1 - u), std::abs(1 - v)});
        if (edge < kEdge * kRounding * scale) continue;  // either answer is right
        EXPECT_TRUE(parity.near(outputs[i].x, reference::intersectQuad(quad, o, d).value_or(-1), scale)) << i;
        const double error = errorBoundInFloat(lines[i]);
        EXPECT_TRUE(bound.near(outputs[i].y, error, error / facing)) << i;
        const double plane = glm::dot(quad.normal, quad.corner - o) / glm::dot(quad.normal, d);
        EXPECT_TRUE(outputs[i].x == -1 || std::abs(outputs[i].x - plane) <= outputs[i].y) << i;
    }
}

/// b^2 - c with the squared distance: what cancels for spheres far away.
float naiveHalfChord(const reference::Sphere<double>& sphere, const Line& line) {
    const glm::vec3 toCenter = glm::vec3(sphere.center) - line.origin;
    const float along = glm::dot(toCenter, line.direction), radius = float(sphere.radius);
    return std::sqrt(along * along - (glm::dot(toCenter, toCenter) - radius * radius));
}

// H42: a sphere 30000 radii away; H40: origins within.
TEST_F(PrimitivesParity, SphereIntervalDoesNotCancelH40H42) {
    // Projection 1 + 3, times the direction 2, difference 1, its square with the radius' 3, root 6.
    constexpr double kAllowed = 16;
    std::vector<Line> lines;
    Stress stress(15);
    for (int i = 0; i < 20'000; ++i) {
        const std::uint32_t which = stress.word() % 2;
        const auto& sphere = scene_.spheres[which];
        const glm::vec3 origin = stress.point(0.5f);
        const glm::vec3 target = glm::vec3(sphere.center) + stress.point(1.2f * float(sphere.radius));
        lines.push_back({origin, glm::normalize(target - origin), which});
    }
    const auto outputs = run(kSphere, lines);
    Parity parity("geometry/primitives", "sphereInterval", kAllowed);
    test::ErrorMeter naive;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto& sphere = scene_.spheres[lines[i].primitive];
        const glm::dvec3 o(lines[i].origin), d(lines[i].direction), toCenter = sphere.center - o;
        const glm::dvec3 perpendicular = toCenter - glm::dot(toCenter, d) * d;
        const double square = sphere.radius * sphere.radius - glm::dot(perpendicular, perpendicular);
        const double slack = 2 * kAllowed * kRounding * sphere.radius * (glm::length(toCenter) + sphere.radius);
        if (std::abs(square) < 4 * slack) continue;  // grazing
        const auto expected = reference::sphereInterval(sphere, o, d);
        ASSERT_EQ(outputs[i].y >= outputs[i].x, expected.has_value()) << i;
        if (!expected) continue;
        const double scale = (glm::length(toCenter) + sphere.radius) * (1 + sphere.radius / std::sqrt(square));
        EXPECT_TRUE(parity.near(outputs[i].x, expected->t0, scale)) << i;
        EXPECT_TRUE(parity.near(outputs[i].y, expected->t1, scale)) << i;
        naive.add(naiveHalfChord(sphere, lines[i]), std::sqrt(square), scale);
    }
    EXPECT_GT(naive.worst(), kAllowed);
}

/// Slabs without care for directions along the faces, in float.
bool naiveSlabsHit(const glm::vec3& o, const glm::vec3& d) {
    float t0 = -INFINITY, t1 = INFINITY;
    for (int i = 0; i < 3; ++i) {
        const float a = (-1 - o[i]) * (1 / d[i]), b = (1 - o[i]) * (1 / d[i]);
        t0 = a < b ? (t0 > a ? t0 : a) : (t0 > b ? t0 : b);  // NaN is taken up, as by a device's min and max may be
        t1 = a < b ? (t1 < b ? t1 : b) : (t1 < a ? t1 : a);
    }
    return t0 <= t1;
}

// H39: 0 * infinity of rays in and along the faces; H40: origins on a face.
TEST_F(PrimitivesParity, BoxIntervalOfRaysAlongFacesAgreesH39H40) {
    std::vector<Line> lines;
    const std::vector<float> coordinates{-3, -1.0000001f, -1, -0.99999994f, 0, 0.5f, 1, 1.0000001f, 2};
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f})
            for (const float a : coordinates)
                for (const float b : coordinates)
                    for (const float c : coordinates)
                        for (const float zero : {0.0f, -0.0f}) {
                            glm::vec3 d(zero);
                            d[axis] = sign;
                            lines.push_back({{a, b, c}, d});
                        }
    const auto outputs = run(kBox, lines);
    Parity parity("geometry/primitives", "boxInterval", 0);  // +-1 - o, over +-1
    int naive = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const glm::vec3& o = lines[i].origin;
        const auto expected = reference::boxInterval(scene_.boxes[0], glm::dvec3(o), glm::dvec3(lines[i].direction));
        ASSERT_EQ(outputs[i].y >= outputs[i].x, expected.has_value()) << i;
        naive += naiveSlabsHit(o, lines[i].direction) != expected.has_value();
        if (!expected) continue;
        EXPECT_TRUE(parity.near(outputs[i].x, float(expected->t0))) << i;
        EXPECT_TRUE(parity.near(outputs[i].y, float(expected->t1))) << i;
    }
    EXPECT_GT(naive, 0);
}

TEST_F(PrimitivesParity, BoxIntervalAgreesWithinItsConditioning) {
    std::vector<Line> lines;
    Stress stress(16);
    for (int i = 0; i < 20'000; ++i) lines.push_back({stress.point(3), stress.direction(), stress.word() % 2});
    const auto outputs = run(kBox, lines);
    // Local position 6, difference 1, reciprocal of the local direction 5 + 3, product 1.
    Parity parity("geometry/primitives", "boxInterval", 16);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto& box = scene_.boxes[lines[i].primitive];
        const glm::dvec3 o(lines[i].origin), d(lines[i].direction);
        const glm::dvec3 local = box.localFromWorld.point(o), along = glm::abs(box.localFromWorld.vector(d));
        const glm::dvec3 size = glm::abs(local) + 2.0 * glm::abs(box.localFromWorld.translation) + 1.0;
        const double scale = std::max({size.x / along.x, size.y / along.y, size.z / along.z});
        const auto expected = reference::boxInterval(box, o, d);
        const bool isHit = outputs[i].y >= outputs[i].x;
        if (isHit != expected.has_value()) {
            // Within rounding of an edge the interval is as good as empty.
            const auto& interval = expected ? glm::dvec2(expected->t0, expected->t1) : glm::dvec2(outputs[i]);
            EXPECT_LE(interval.y - interval.x, 2 * 16 * kRounding * scale) << i;
            continue;
        }
        if (!expected) continue;
        EXPECT_TRUE(parity.near(outputs[i].x, expected->t0, scale)) << i;
        EXPECT_TRUE(parity.near(outputs[i].y, expected->t1, scale)) << i;
    }
}

}  // namespace
}  // namespace parhelion
