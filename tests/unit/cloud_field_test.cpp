// The field of procedural clouds: its noises, and the sweep from cube to cloud. On the reference, whose bits the device
// has.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

#include "gpu/pipeline.h"
#include "reference/cloud_baker.h"
#include "reference/volume/procedural_cloud.h"
#include "support/cloud_fields.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::Stress;
using test::sweepField;

TEST(CloudNoise, StaysInItsRangeAndFillsIt) {
    Stress stress(51);
    glm::vec3 least(1), most(0);
    float nearest = 1, farthest = 0;
    for (int i = 0; i < 200'000; ++i) {
        const glm::vec3 x = stress.point(100);
        const glm::vec3 sum = reference::fbm(x, 9, 3);
        const float cells = reference::worley(x, 9, 3);
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(sum, glm::vec3(0))) &&
                    glm::all(glm::lessThanEqual(sum, glm::vec3(1))));
        ASSERT_TRUE(cells >= 0 && cells <= 1) << cells;
        least = glm::min(least, sum), most = glm::max(most, sum);
        nearest = std::min(nearest, cells), farthest = std::max(farthest, cells);
    }
    for (int c = 0; c < 3; ++c) {
        EXPECT_LT(least[c], 0.12f);
        EXPECT_GT(most[c], 0.88f);
    }
    EXPECT_LT(nearest, 0.001f);
    EXPECT_GT(farthest, 0.98f);
}

// Slopes: valueNoise 15/8 along an axis (the fade's largest), so fbm 12/7 of that; worley, a squared distance below
// 1, 2.
TEST(CloudNoise, IsContinuousAcrossCells) {
    Stress stress(52);
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 20'000; ++i) {
        glm::dvec3 a(stress.point(8)), b;
        a[i % 3] = std::round(a[i % 3]) - 0.5 * kStep * (i % 2);  // on both sides of a border, or from it
        b = a;
        b[i % 3] += kStep;
        EXPECT_NEAR(reference::valueNoise(a, 1, 2).x, reference::valueNoise(b, 1, 2).x, 15.0 / 8 * kStep);
        EXPECT_NEAR(reference::fbm(a, 1, 2).y, reference::fbm(b, 1, 2).y, 12.0 / 7 * 15 / 8 * kStep);
        EXPECT_NEAR(reference::worley(a, 1, 2), reference::worley(b, 1, 2), 2 * kStep + 1e-12);
    }
}

// At a border the fade's first two derivatives are 0 on both sides: at a distance h of it the slope across is at most
// 30 h^2, and the second difference over h is 60 h^3 rather than the kink's 2 * slope * h.
TEST(CloudNoise, IsSmoothAtTheBordersOfItsCells) {
    Stress stress(53);
    constexpr double h = 1e-3;
    for (int i = 0; i < 5'000; ++i) {
        glm::dvec3 x(stress.point(8)), step(0);
        x[i % 3] = std::round(x[i % 3]);
        step[i % 3] = h;
        const double before = reference::valueNoise(x - step, 5, 0).z, at = reference::valueNoise(x, 5, 0).z;
        const double after = reference::valueNoise(x + step, 5, 0).z;
        EXPECT_NEAR(after - 2 * at + before, 0, 60 * h * h * h);
    }
}

// Every point has a field of its own; the detail deviates by 0.2 (rms), the mean of 400 000 by 0.0003: 16 sigma.
TEST(CloudNoise, MeanOfTheDetailIsWhatModulationAssumes) {
    Stress stress(54);
    double sum = 0;
    constexpr int kPoints = 400'000;
    shared::CloudField field = sweepField(0.62f, 32);
    field.erosionAmount = 0;
    for (int i = 0; i < kPoints; ++i) {
        field.noiseSeed = stress.word();
        sum += reference::cloudDetail(reference::cloudOf<double>(field, 0), glm::dvec3(0.5f + 0.5f * stress.point(1)));
    }
    EXPECT_NEAR(sum / kPoints, shared::kCloudMeanDetail, 0.005);
}

std::uint64_t hashOf(std::span<const float> values) {
    std::uint64_t hash = 14695981039346656037u;  // FNV-1a
    for (const float value : values) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        for (int byte = 0; byte < 4; ++byte) hash = (hash ^ (bits >> 8 * byte & 255)) * 1099511628211u;
    }
    return hash;
}

// The number that every device and version must reproduce: scenes look the same for ever.
TEST(ProceduralCloud, SeedGivesTheSameBitsForEver) {
    EXPECT_EQ(hashOf(reference::bakeCloud<float>(sweepField(0.62f, 24), {}, 0)), 5199881228228417068u);
    shared::CloudField other = sweepField(0.62f, 24);
    other.noiseSeed = 5;
    EXPECT_NE(reference::bakeCloud<float>(other, {}, 0), reference::bakeCloud<float>(sweepField(0.62f, 24), {}, 0));
}

// Vulkan lets a device join a product and a sum into one rounding unless both are marked.
TEST(ProceduralCloud, DeviceRoundsEveryOperationOnItsOwn) {
    const std::vector<std::uint32_t> words = gpu::compileShader(gpu::shaderFolder() / "kernels/bake_cloud.comp");
    enum Op : std::uint32_t { kDecorate = 71, kFAdd = 129, kFSub = 131, kFMul = 133, kFDiv = 136, kDot = 148 };
    constexpr std::uint32_t kNoContraction = 42, kTimesScalar = 142;
    std::set<std::uint32_t> marked;
    int operations = 0, unmarked = 0;
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
        const std::uint32_t op = words[at] & 0xffff;
        if (op == kDecorate && words[at + 2] == kNoContraction) marked.insert(words[at + 1]);
        EXPECT_TRUE(op != kFDiv && op != kDot) << "rounded as the device likes";
        if (op != kFAdd && op != kFSub && op != kFMul && op != kTimesScalar) continue;
        ++operations;
        unmarked += !marked.contains(words[at + 2]);
    }
    EXPECT_GT(operations, 80);
    EXPECT_LE(unmarked, 1) << "toUniform's, times a power of two, is exact";
}

TEST(ProceduralCloud, WithoutDetailIsASmoothCube) {
    const shared::CloudField field = sweepField(0, 40);
    const std::vector<float> values = reference::bakeCloud<double>(field, {}, 0);
    for (unsigned i = 0; i < values.size(); ++i) {
        const glm::dvec3 p = (glm::dvec3(i % 40, i / 40 % 40, i / 1600) + 0.5) / 40.0;
        // From first principles: the nearest point of a box of half edge 0.26, less the radius 0.08.
        const glm::dvec3 v = p - 0.5, outside = glm::max(glm::abs(v) - double(shared::kCloudBoxCore), 0.0);
        double phi = std::hypot(outside.x, outside.y, outside.z);
        if (phi == 0) phi = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) - double(shared::kCloudBoxCore);
        phi -= double(shared::kCloudBoxRadius);
        const double w = double(field.surfaceWidth) / 2, t = std::clamp((w - phi) / (2 * w), 0.0, 1.0);
        double density = double(field.densityScale) * t * t * (3 - 2 * t);
        if (std::abs(density - double(field.densityThreshold)) < 1e-9) continue;
        if (density < double(field.densityThreshold)) density = 0;
        ASSERT_NEAR(values[i], density, 1e-7) << i;  // stored in single precision
    }
}

struct Shape {
    double volume = 0, difference = 0, area = 0, side = 0;
};

/// Mean density, mean distance from the cube, area (of the surfaces of equal density, mean), largest density at a side.
Shape measure(const std::vector<float>& values, const std::vector<float>& cube, unsigned n) {
    Shape shape;
    for (unsigned i = 0; i < values.size(); ++i) {
        shape.volume += values[i] / double(values.size());
        shape.difference += std::abs(values[i] - cube[i]) / double(values.size());
        const unsigned x = i % n, y = i / n % n, z = i / (n * n);
        if (x == 0 || y == 0 || z == 0 || x == n - 1 || y == n - 1 || z == n - 1) {
            shape.side = std::max(shape.side, double(values[i]));
            continue;
        }
        const glm::dvec3 gradient(values[i + 1] - values[i - 1], values[i + n] - values[i - n],
                                  values[i + n * n] - values[i - n * n]);
        shape.area += glm::length(gradient) * n / 2 / double(values.size());
    }
    return shape;
}

// From cube to cloud without a jump: each step leads further from the cube, by nearly what the step before did.
TEST(ProceduralCloud, SweepIsMonotoneAndSmooth) {
    constexpr unsigned kSize = 48;
    constexpr int kSteps = 31;
    const std::vector<float> cube = reference::bakeCloud<float>(sweepField(0, kSize), {}, 0);
    const Shape first = measure(cube, cube, kSize);
    Shape last = first;
    double lastMoved = 0;
    std::vector<float> before = cube;
    for (int step = 1; step <= kSteps; ++step) {
        const std::vector<float> values = reference::bakeCloud<float>(sweepField(0.02f * float(step), kSize), {}, 0);
        const Shape shape = measure(values, cube, kSize);
        const double moved = measure(values, before, kSize).difference;
        EXPECT_GT(shape.difference, last.difference) << step;
        if (step > 1) {
            EXPECT_NEAR(moved / lastMoved, 1, 0.1) << step;
        }
        EXPECT_LT(shape.volume, last.volume) << step;
        EXPECT_GT(shape.volume, 0.5 * first.volume) << step;
        EXPECT_EQ(shape.side, 0) << "cut at its box, " << step;
        last = shape, lastMoved = moved, before = values;
    }
    // Rougher: more surface around what is left than around the same volume of cube.
    EXPECT_GT(last.area / std::pow(last.volume, 2.0 / 3), 1.2 * first.area / std::pow(first.volume, 2.0 / 3));
}

}  // namespace
}  // namespace parhelion
