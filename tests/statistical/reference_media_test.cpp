#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "reference/reference_renderer.h"
#include "support/tracked_medium.h"

namespace parhelion {
namespace {

using test::HandScene;
using test::lumpyVoxels;
using test::PixelEstimate;

// |z| for a family of 1e-6 over the dozen comparisons of a test.
constexpr double kZ = 5.5;

void expectEqual(const PixelEstimate& a, const PixelEstimate& b, const std::string& what) {
    EXPECT_LT(std::abs(a.mean - b.mean) / std::hypot(a.error, b.error, 1e-7), kZ)
        << what << ": " << a.mean << " +- " << a.error << " and " << b.mean << " +- " << b.error;
}

void expectValue(const PixelEstimate& a, double exact, const std::string& what) {
    EXPECT_LT(std::abs(a.mean - exact) / std::hypot(a.error, 1e-6), kZ)
        << what << ": " << a.mean << " +- " << a.error << ", exact " << exact;
}

constexpr glm::uvec3 kResolution = test::kLumpyResolution;
constexpr glm::vec3 kLow{-2, -1.5f, -5}, kHigh{2, 1.5f, -2};

float voxel(const std::vector<float>& voxels, glm::ivec3 i) {
    i = glm::clamp(i, glm::ivec3(0), glm::ivec3(kResolution) - 1);
    return voxels[(std::size_t(i.z) * kResolution.y + i.y) * kResolution.x + i.x];
}

/// Trilinear density along a ray from the origin, integrated by Simpson's rule over many steps.
double opticalDepth(const std::vector<float>& voxels, glm::dvec3 direction, double sigma) {
    const auto density = [&](double t) {
        const glm::dvec3 p = t * direction;
        if (glm::any(glm::lessThan(p, glm::dvec3(kLow))) || glm::any(glm::greaterThan(p, glm::dvec3(kHigh))))
            return 0.0;
        const glm::dvec3 s = (p - glm::dvec3(kLow)) / glm::dvec3(kHigh - kLow) * glm::dvec3(kResolution) - 0.5;
        const glm::ivec3 i(glm::floor(s));
        const glm::dvec3 f = s - glm::floor(s);
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::ivec3 c(corner & 1, corner >> 1 & 1, corner >> 2);
            const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(c));
            sum += w.x * w.y * w.z * voxel(voxels, i + c);
        }
        return sum;
    };
    // Kinks at voxel planes and jumps at the box limit Simpson to O(step): 1e-5 of the value with 200000 steps.
    constexpr int kSteps = 200000;
    const double step = 10.0 / kSteps;
    double sum = 0;
    for (int i = 0; i <= kSteps; ++i) sum += (i == 0 || i == kSteps ? 1 : (i % 2 ? 4 : 2)) * density(i * step);
    return sigma * sum * step / 3;
}

HandScene gridScene(float sigma, glm::vec3 albedo, const std::vector<float>& voxels, glm::vec3 direction,
                    float slack = 1) {
    HandScene scene;
    scene.lookAlong(direction);
    scene.addBox(kLow, kHigh, scene.addNull(scene.addGrid(sigma, albedo, kResolution, voxels, kLow, kHigh, slack)));
    scene.setEnvironment(glm::vec3(1));
    return scene;
}

const std::vector<glm::vec3> kDirections{{0, 0, -1}, {0.3f, 0.1f, -1}, {-0.2f, 0.4f, -1}, {0.5f, -0.3f, -1}};

TEST(ReferenceGrid, FlightsSeeTheTransmittanceOfTheInterpolatedDensity) {
    // Black medium: the sky seen through it is exactly the transmittance.
    const std::vector<float> voxels = lumpyVoxels();
    for (const glm::vec3 direction : kDirections) {
        const double exact = std::exp(-opticalDepth(voxels, glm::normalize(glm::dvec3(direction)), 2));
        HandScene scene = gridScene(2, glm::vec3(0), voxels, direction);
        expectValue(test::renderPixel(scene.scene, 400000), exact, "float");
        expectValue(test::renderPixel(scene.scene, 400000, true), exact, "double");
    }
}

TEST(ReferenceGrid, ShadowRaysSeeTheTransmittanceOfTheInterpolatedDensity) {
    // A white wall seen through nothing, lit through the grid by a directional light: E T / pi.
    const std::vector<float> voxels = lumpyVoxels();
    for (const glm::vec3 direction : kDirections)
        for (const float roulette : {0.0f, 3.0f}) {
            HandScene scene;
            const glm::vec3 towards = glm::normalize(direction);
            scene.lookAlong(-towards);
            const std::uint32_t wall = scene.addDiffuse(glm::vec3(1));
            const glm::vec3 u = glm::normalize(glm::cross(towards, glm::vec3(0, 1, 0))), v = glm::cross(towards, u);
            // Just behind the camera, so that the grid starts where the direction from the origin meets it.
            scene.addQuad(-1e-3f * towards - 0.5f * u - 0.5f * v, u, v, wall);
            scene.addBox(kLow, kHigh, scene.addNull(scene.addGrid(2, glm::vec3(0), kResolution, voxels, kLow, kHigh)));
            shared::Light sun{};
            sun.type = shared::kLightDirectional;
            sun.emission = glm::vec3(1);
            sun.vector = -towards;
            scene.addLight(sun);
            scene.scene.constants.maxDepth = 2;
            RenderSettings settings;
            settings.sampleCount = 400000;
            settings.quality.shadowRoulette = roulette;
            const Film film = reference::render<float>(scene.scene, settings);
            const PixelEstimate found = test::estimate(film.pixels[0], film.samples);
            const double transmittance = std::exp(-opticalDepth(voxels, glm::dvec3(towards), 2));
            expectValue(found, transmittance / 3.14159265358979, "roulette " + std::to_string(roulette));
            EXPECT_EQ(film.counters[shared::kCounterMajorantViolations], 0u);
        }
}

TEST(ReferenceGrid, LookupsOfOneAndOfEightVoxelsHaveTheSameMean) {
    HandScene scene = gridScene(4, glm::vec3(0.9f), lumpyVoxels(), {0.3f, 0.1f, -1});
    scene.setEnvironment({1, 1, 1});
    RenderSettings settings;
    settings.sampleCount = 200000;
    const Film one = reference::render<float>(scene.scene, settings);
    settings.quality.stochasticFilter = false;
    const Film eight = reference::render<float>(scene.scene, settings);
    EXPECT_NE(one.pixels[0].sumHigh.x, eight.pixels[0].sumHigh.x);
    expectEqual(test::estimate(one.pixels[0], one.samples), test::estimate(eight.pixels[0], eight.samples), "lookup");
}

TEST(ReferenceGrid, ConstantDensityIsTheHomogeneousMedium) {  // H24, H23
    HandScene homogeneous;
    homogeneous.lookAlong({0.3f, 0.1f, -1});
    homogeneous.addBox(kLow, kHigh, homogeneous.addNull(homogeneous.addHomogeneous(1.5f, glm::vec3(0.8f))));
    homogeneous.setEnvironment(glm::vec3(1));
    const PixelEstimate exact = test::renderPixel(homogeneous.scene, 400000);
    const std::size_t count = kResolution.x * kResolution.y * kResolution.z;
    for (const float slack : {1.0f, 1.5f, 20.0f}) {  // H19, H20
        HandScene grid = gridScene(3, glm::vec3(0.8f), std::vector<float>(count, 0.5f), {0.3f, 0.1f, -1}, slack);
        expectEqual(test::renderPixel(grid.scene, 200000), exact, "slack " + std::to_string(slack));
    }
}

TEST(ReferenceGrid, BricksHoldTheSameAsTheDenseArray) {
    const std::vector<float> voxels = lumpyVoxels();
    HandScene dense = gridScene(4, glm::vec3(0.9f), voxels, {0.3f, 0.1f, -1});
    HandScene bricked = dense;
    shared::Medium& medium = bricked.medium(0);
    medium.flags |= shared::kMediumBricked;
    CompiledScene& scene = bricked.scene;
    scene.density.clear();
    for (unsigned brick = 0; brick < medium.cells.x * medium.cells.y * medium.cells.z; ++brick) {
        const glm::uvec3 at(brick % medium.cells.x, brick / medium.cells.x % medium.cells.y,
                            brick / (medium.cells.x * medium.cells.y));
        scene.brickTable.push_back(std::uint32_t(scene.density.size()));
        for (unsigned i = 0; i < 512; ++i)
            scene.density.push_back(voxel(voxels, glm::ivec3(at * 8u + glm::uvec3(i % 8, i / 8 % 8, i / 64))));
    }
    EXPECT_EQ(test::renderPixel(bricked.scene, 1000).mean, test::renderPixel(dense.scene, 1000).mean);
    // An empty brick is one of zeros.
    const std::uint32_t first = scene.brickTable[0];
    std::fill_n(scene.density.begin() + first, 512, 0.0f);
    const double zeros = test::renderPixel(bricked.scene, 1000).mean;
    scene.brickTable[0] = shared::kEmptyBrick;
    EXPECT_EQ(test::renderPixel(bricked.scene, 1000).mean, zeros);
}

TEST(ReferenceGrid, BoundsBelowTheDensityAreCounted) {  // H17
    HandScene scene = gridScene(4, glm::vec3(0.9f), lumpyVoxels(), {0.3f, 0.1f, -1}, 0.9f);
    RenderSettings settings;
    settings.sampleCount = 10000;
    EXPECT_GT(reference::render<float>(scene.scene, settings).counters[shared::kCounterMajorantViolations], 0u);
}

/// Albedo `near` in the half of the box nearer to the camera, `far` in the other, linear between the voxel centres.
HandScene withAlbedoGrid(float near, float far) {
    HandScene scene = gridScene(3, glm::vec3(0.1f), lumpyVoxels(), {0.1f, 0.1f, -1});
    shared::Medium& medium = scene.medium(0);
    medium.flags |= shared::kMediumAlbedoGrid;
    medium.albedoResolution = {1, 1, 2};
    medium.albedoFromWorld = {{0.25f, 0, 0}, {0, 1 / 3.0f, 0}, {0, 0, 2 / 3.0f}, {0.5f, 0.5f, 10 / 3.0f}};
    scene.scene.albedoVoxels = {glm::vec4(far), glm::vec4(near)};
    scene.scene.constants.maxDepth = 2;
    return scene;
}

TEST(ReferenceGrid, SingleScatteringIsLinearInTheAlbedoGrid) {
    HandScene constant = gridScene(3, glm::vec3(0.7f), lumpyVoxels(), {0.1f, 0.1f, -1});
    constant.scene.constants.maxDepth = 2;
    const double whole = test::renderPixel(constant.scene, 10000).mean;
    EXPECT_EQ(test::renderPixel(withAlbedoGrid(0.7f, 0.7f).scene, 10000).mean, whole);
    HandScene black = constant;
    black.medium(0).albedo = glm::vec3(0);
    const double unscattered = test::renderPixel(black.scene, 10000).mean;
    const double near = test::renderPixel(withAlbedoGrid(0.7f, 0).scene, 10000).mean - unscattered;
    const double far = test::renderPixel(withAlbedoGrid(0, 0.7f).scene, 10000).mean - unscattered;
    // The same collisions, each at one of the two voxels in one of the two renders: rounding only.
    EXPECT_NEAR(near + far, whole - unscattered, 1e-6);
    EXPECT_GT(near, 1.5 * far);
}

TEST(ReferenceChromatic, EachChannelSeesItsOwnExtinction) {  // H36: one channel of no extinction at all
    const glm::vec3 ratio{0, 0.25f, 1};
    const std::size_t count = kResolution.x * kResolution.y * kResolution.z;
    for (int channel = 0; channel < 3; ++channel) {
        HandScene grey;
        grey.lookAlong({0, 0, -1});
        // A channel without extinction is a medium too thin to matter, which the renderer must not be given.
        grey.addBox(kLow, kHigh,
                    grey.addNull(grey.addHomogeneous(std::max(1e-9f, 2 * ratio[channel]), glm::vec3(0.6f), 0.5f)));
        grey.setEnvironment(glm::vec3(1));
        const PixelEstimate exact = test::renderPixel(grey.scene, 400000);

        HandScene chromatic;
        chromatic.lookAlong({0, 0, -1});
        chromatic.addBox(kLow, kHigh, chromatic.addNull(chromatic.addHomogeneous(2, glm::vec3(0.6f), 0.5f, ratio)));
        chromatic.setEnvironment(glm::vec3(1));
        expectEqual(test::renderPixel(chromatic.scene, 400000, false, channel), exact,
                    "homogeneous " + std::to_string(channel));

        HandScene grid = gridScene(4, glm::vec3(0.6f), std::vector<float>(count, 0.5f), {0, 0, -1});
        grid.medium(0).sigmaRatio = ratio;
        grid.medium(0).g = 0.5f;
        grid.medium(0).phase = shared::kPhaseHenyeyGreenstein;
        expectEqual(test::renderPixel(grid.scene, 400000, false, channel), exact, "grid " + std::to_string(channel));
    }
}

}  // namespace
}  // namespace parhelion
