// shaders/core/frame.glsl against double precision.
#include "reference/core/frame.h"

#include <gtest/gtest.h>

#include "support/gpu_fixture.h"
#include "support/parity_report.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::Parity;
using test::Stress;

/// Worst departure from orthonormality of three vectors, absolute.
double defect(const glm::dvec3& t, const glm::dvec3& b, const glm::dvec3& n) {
    return std::max({std::abs(glm::dot(t, b)), std::abs(glm::dot(t, n)), std::abs(glm::dot(b, n)),
                     std::abs(glm::dot(t, t) - 1), std::abs(glm::dot(b, b) - 1)});
}

/// Frisvad 2012 without its special case, in float: what the shader must not do.
double frisvadDefect(const glm::vec3& n) {
    const float a = 1.0f / (1.0f + n.z), b = -n.x * n.y * a;
    return defect({1.0f - n.x * n.x * a, b, -n.x}, {b, 1.0f - n.y * n.y * a, -n.y}, n);
}

// H10: normals at and next to -z.
TEST(FrameParity, AgreesAndStaysOrthonormalForEveryNormalH10) {
    std::vector<glm::vec4> inputs;
    Stress stress(6);
    for (const glm::vec3& normal : test::stressDirections(5'000)) {
        inputs.emplace_back(normal, 0);
        inputs.emplace_back(stress.direction(), 0);
    }
    const auto outputs = test::probe("parity/frame.comp", 0, inputs, 2, 3);
    // Of numbers up to 1: sum and division (2.5 ulp in Vulkan) 6, two products 2, the last sum 1.
    Parity basis("core/frame", "frameFromNormal", 9);
    // Three components of those, each a product and a sum more.
    Parity world("core/frame", "toWorld", 3 * (9 + 2));
    constexpr double kOrthonormal = 5e-7;
    double naive = 0;
    for (std::size_t i = 0; i < inputs.size() / 2; ++i) {
        const glm::vec3 normal(inputs[2 * i]);
        const auto frame = reference::frameFromNormal(glm::dvec3(normal));
        EXPECT_TRUE(basis.near(outputs[3 * i], frame.tangent)) << glm::dvec3(normal).z;
        EXPECT_TRUE(basis.near(outputs[3 * i + 1], frame.bitangent)) << glm::dvec3(normal).z;
        EXPECT_TRUE(world.near(outputs[3 * i + 2], reference::toWorld(frame, glm::dvec3(inputs[2 * i + 1])))) << i;
        EXPECT_LE(defect(outputs[3 * i], outputs[3 * i + 1], normal), kOrthonormal) << i;
        naive = std::max(naive, frisvadDefect(normal));
    }
    EXPECT_FALSE(naive <= kOrthonormal);
}

}  // namespace
}  // namespace parhelion
