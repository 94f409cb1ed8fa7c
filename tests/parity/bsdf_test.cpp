// shaders/surface/bsdf.glsl against double precision.
#include "reference/surface/bsdf.h"

#include <gtest/gtest.h>

#include "support/gpu_fixture.h"
#include "support/parity_report.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::Parity;
using test::Stress;

TEST(BsdfParity, DiffuseValueSampleAndDensityAgree) {
    std::vector<glm::vec4> inputs;
    Stress stress(17);
    const auto uniforms = test::stressUniforms();
    for (const glm::vec3& normal : test::stressDirections(3'000))
        for (int i = 0; i < 3; ++i) {
            inputs.emplace_back(normal, 0);
            inputs.emplace_back(i == 0 ? -normal : stress.direction(), 0);
            inputs.emplace_back(uniforms[stress.word() % uniforms.size()], stress.between(0, 1), 0, 0);
        }
    const auto outputs = test::probe("parity/bsdf.comp", 0, inputs, 3, 2);
    // Products and sums of the dot product 5, 1 / pi and its product 2.
    Parity value("surface/bsdf", "evalDiffuse", 7), density("surface/bsdf", "pdfDiffuse", 7);
    // Warp 10 and basis 9, product and sum 2, in three components, then the normalisation's root and quotient 9.
    Parity sample("surface/bsdf", "sampleDiffuse", 3 * (10 + 9 + 2) + 9);
    // Root of 1 - u (6), and the product.
    Parity sampleDensity("surface/bsdf", "pdfDiffuse", 8);
    for (std::size_t i = 0; i < outputs.size() / 2; ++i) {
        const glm::dvec3 normal(inputs[3 * i]), wi(inputs[3 * i + 1]);
        const auto expected = reference::sampleDiffuse(normal, glm::dvec2(inputs[3 * i + 2]));
        EXPECT_TRUE(sample.near(outputs[2 * i], expected.direction)) << i;
        EXPECT_TRUE(sampleDensity.near(outputs[2 * i].w, expected.pdf, 1 / reference::kPi<double>)) << i;
        EXPECT_TRUE(value.near(outputs[2 * i + 1].x, reference::evalDiffuse(normal, wi), 1)) << i;
        EXPECT_TRUE(density.near(outputs[2 * i + 1].y, reference::pdfDiffuse(normal, wi), 1)) << i;
    }
}

}  // namespace
}  // namespace parhelion
