// shaders/volume/cloud_noise.glsl and procedural_cloud.glsl: the bits of the reference in float, and close to it in
// double.
#include "reference/volume/procedural_cloud.h"

#include <gtest/gtest.h>

#include "reference/cloud_baker.h"
#include "render/bake_cloud.h"
#include "support/cloud_fields.h"
#include "support/gpu_fixture.h"
#include "support/parity_report.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::kRounding;
using test::Parity;
using test::Stress;
using test::sweepField;

const char* const kShader = "parity/procedural_cloud.comp";
enum Function : std::uint32_t { kNoise, kCloud };

/// x and a weight; seed, stream. Random places on both sides of 0, and lattice points with the floats next to them.
std::vector<glm::vec4> noiseInputs() {
    std::vector<glm::vec4> inputs;
    Stress stress(41);
    const auto add = [&](const glm::vec3& x) {
        inputs.emplace_back(x, stress.between(0, 1));
        inputs.emplace_back(stress.word() >> 8, stress.word() % 40, stress.between(-1, 1), 0);
    };
    for (int i = 0; i < 4000; ++i) add(stress.point(20));
    for (int i = 0; i < 500; ++i) {
        const glm::vec3 lattice = glm::round(stress.point(5));
        add(lattice);
        add({std::nextafter(lattice.x, -9.0f), lattice.y, std::nextafter(lattice.z, 9.0f)});
    }
    return inputs;
}

TEST(CloudNoiseParity, DeviceHasTheBitsOfTheReference) {
    const std::vector<glm::vec4> inputs = noiseInputs();
    const auto outputs = test::probe(kShader, kNoise, inputs, 2, 4);
    Parity noise("volume/cloud_noise", "valueNoise", 0), cells("volume/cloud_noise", "worley", 0);
    Parity sum("volume/cloud_noise", "fbm", 0), words("volume/cloud_noise", "cellUniforms", 0);
    Parity lerp("volume/cloud_noise", "lerpPrecisely", 0);
    for (std::size_t i = 0; i < inputs.size() / 2; ++i) {
        const glm::vec3 x(inputs[2 * i]), other(inputs[2 * i + 1]);
        const auto seed = std::uint32_t(other.x), stream = std::uint32_t(other.y);
        const glm::vec4* rows = &outputs[4 * i];
        EXPECT_TRUE(noise.near(rows[0], reference::valueNoise(x, seed, stream))) << i;
        EXPECT_TRUE(cells.near(rows[0].w, reference::worley(x, seed, stream))) << i;
        EXPECT_TRUE(sum.near(rows[1], reference::fbm(x, seed, stream))) << i;
        EXPECT_TRUE(words.near(rows[2], reference::cellUniforms<float>(glm::ivec3(glm::floor(x)), seed, stream))) << i;
        EXPECT_TRUE(lerp.near(rows[3], reference::lerpPrecisely(x, other, inputs[2 * i].w))) << i;
    }
}

// Roundings of valueNoise: 43 of the fade (its polynomial passes through numbers up to 15 and ends in [1, 10]; three
// factors), 3 of each lerp, on three axes: 138. Of fbm: the mean of three of those, 3 sums and a product: 145. Of
// worley: a point 2, its difference 2, of size up to 2: 8 for d d near 1, three of those and their sums: 30.
TEST(CloudNoiseParity, RoundingStaysWithinItsBound) {
    const std::vector<glm::vec4> inputs = noiseInputs();
    const auto outputs = test::probe(kShader, kNoise, inputs, 2, 4);
    for (std::size_t i = 0; i < inputs.size() / 2; ++i) {
        const glm::dvec3 x(inputs[2 * i]);
        const auto seed = std::uint32_t(inputs[2 * i + 1].x), stream = std::uint32_t(inputs[2 * i + 1].y);
        const glm::dvec3 noise = reference::valueNoise(x, seed, stream), sum = reference::fbm(x, seed, stream);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(outputs[4 * i][c], noise[c], 138 * kRounding) << i;
            EXPECT_NEAR(outputs[4 * i + 1][c], sum[c], 145 * kRounding) << i;
        }
        EXPECT_NEAR(outputs[4 * i].w, reference::worley(x, seed, stream), 30 * kRounding) << i;
    }
}

/// Fields as the device is told of them, at random points, with a density to modulate in [0, 2].
struct CloudCases {
    std::vector<shared::CloudField> fields;
    std::vector<glm::vec4> inputs;  // 4 rows each

    CloudCases() {
        Stress stress(42);
        for (int i = 0; i < 4000; ++i) {
            shared::CloudField field = sweepField(stress.between(0, 1.2f), 32);
            if (i % 2) field.noiseScale = stress.magnitude(0.1f, 20);
            if (i % 3) field.surfaceWidth = stress.magnitude(0.01f, 1);
            field.warpAmount = stress.between(0, 0.5f);
            field.noiseSeed = stress.word() >> 8;
            field.resolution = {32, 1 + stress.word() % 32, 7};
            const shared::CloudArguments a = render::cloudArguments(field, 2);
            inputs.emplace_back(glm::vec3(0.5f) + stress.point(0.5f), stress.between(0, 2));
            inputs.emplace_back(a.frequency, a.blend);
            inputs.emplace_back(a.sharpness, a.detailAmount, a.warpAmount, a.erosionAmount);
            inputs.emplace_back(a.densityScale, a.densityThreshold, a.inverseLargest, a.noiseSeed);
            fields.push_back(field);
        }
    }
};

TEST(ProceduralCloudParity, DeviceHasTheBitsOfTheReference) {
    const CloudCases cases;
    const auto outputs = test::probe(kShader, kCloud, cases.inputs, 4, 3);
    Parity box("volume/procedural_cloud", "boxDistance", 0), blob("volume/procedural_cloud", "blobDistance", 0);
    Parity detail("volume/procedural_cloud", "cloudDetail", 0), surface("volume/procedural_cloud", "cloudSurface", 0);
    Parity displaced("volume/procedural_cloud", "displacedDensity", 0);
    Parity modulated("volume/procedural_cloud", "modulatedDensity", 0);
    Parity density("volume/procedural_cloud", "cloudDensity", 0);
    Parity length("volume/procedural_cloud", "lengthPrecisely sphereDistance", 0);
    for (std::size_t i = 0; i < cases.fields.size(); ++i) {
        const glm::vec3 p(cases.inputs[4 * i]);
        const float base = cases.inputs[4 * i].w;
        reference::Cloud<float> cloud = reference::cloudOf<float>(cases.fields[i], 2);
        const glm::vec4* rows = &outputs[3 * i];
        EXPECT_TRUE(box.near(rows[0].x, reference::boxDistance(p))) << i;
        EXPECT_TRUE(blob.near(rows[0].y, reference::blobDistance(p))) << i;
        EXPECT_TRUE(detail.near(rows[0].z, reference::cloudDetail(cloud, p))) << i;
        EXPECT_TRUE(surface.near(rows[0].w, reference::cloudSurface(cloud, p.x - 0.5f))) << i;
        EXPECT_TRUE(displaced.near(rows[1].x, reference::displacedDensity(cloud, p))) << i;
        EXPECT_TRUE(modulated.near(rows[1].y, reference::modulatedDensity(cloud, p, base))) << i;
        EXPECT_TRUE(density.near(rows[1].z, reference::cloudDensity(cloud, p, base))) << i;
        cloud.field.modulates = 1;
        EXPECT_TRUE(density.near(rows[1].w, reference::cloudDensity(cloud, p, base))) << i;
        EXPECT_TRUE(length.near(rows[2].x, reference::lengthPrecisely(p))) << i;
        EXPECT_TRUE(length.near(rows[2].y, reference::sphereDistance(p, glm::vec3(0.25f, 0.5f, 0.75f), 0.125f))) << i;
    }
}

// fbm changes by at most 9.6 a lattice cell (fade 15/8 on three axes, octaves 12/7), worley by 2. With f cells along
// the cube and warp w, q is off by e = 2 (f + w) + w (2 * 145 + 2 + 9.6 * 2 f) roundings; the detail by 0.45 (9.6 *
// 0.55 + ...) e + 0.65 * 2 * 1.65 e + erosion * 9.6 * 7 e = 25 e, half as much again for the roundings of the factors
// times q, plus 300 for the noises themselves. phi has half of detailAmount of that and 10 of its own, the surface 1.5
// / surfaceWidth of phi's. A bound, rarely approached: it would find a wrong digit of any constant.
TEST(ProceduralCloudParity, RoundingStaysWithinItsBound) {
    const CloudCases cases;
    const auto outputs = test::probe(kShader, kCloud, cases.inputs, 4, 3);
    for (std::size_t i = 0; i < cases.fields.size(); ++i) {
        const shared::CloudField& field = cases.fields[i];
        const glm::dvec3 p(cases.inputs[4 * i]);
        const auto cloud = reference::cloudOf<double>(field, 2);
        const double f = field.noiseScale, w = field.warpAmount;
        const double detail = 1.5 * 25 * (2 * (f + w) + w * (292 + 19.2 * f)) + 300;
        EXPECT_NEAR(outputs[3 * i].z, reference::cloudDetail(cloud, p), detail * kRounding) << i;
        // Where rounding may decide on the threshold, either density will do.
        const double allowed = (1.5 / field.surfaceWidth * (0.5 * field.detailAmount * detail + 10) + 10) * kRounding;
        const double density = reference::displacedDensity(cloud, p);
        if (density > field.densityThreshold + allowed || density == 0) {
            const double margin = density == 0 ? field.densityThreshold + allowed : 0;
            EXPECT_NEAR(outputs[3 * i + 1].x, density, std::max(allowed, margin * (outputs[3 * i + 1].x > 0))) << i;
        }
    }
}

TEST(ProceduralCloudParity, BakedGridsHaveTheSameBits) {
    for (const float detail : {0.0f, 0.18f, 0.62f}) {
        shared::CloudField field = sweepField(detail, 32);
        field.resolution = {33, 20, 17};  // no multiple of the work group
        EXPECT_EQ(render::bakeCloud(test::testDevice(), field, {}, 0), reference::bakeCloud<float>(field, {}, 0));
        field.modulates = 1;
        std::vector<float> base(33 * 20 * 17);
        for (std::size_t i = 0; i < base.size(); ++i) base[i] = float(i % 101) / 50;
        const std::vector<float> baked = render::bakeCloud(test::testDevice(), field, base, 2);
        EXPECT_EQ(baked, reference::bakeCloud<float>(field, base, 2));
        EXPECT_EQ(baked == base, detail == 0.0f);
    }
}

// A grid of several slabs: each voxel is where it belongs.
TEST(ProceduralCloudParity, SlabsJoin) {
    shared::CloudField field = sweepField(0.38f, 32);
    field.resolution = glm::uvec3(72);  // 2.8 slabs
    EXPECT_EQ(render::bakeCloud(test::testDevice(), field, {}, 0), reference::bakeCloud<float>(field, {}, 0));
}

}  // namespace
}  // namespace parhelion
