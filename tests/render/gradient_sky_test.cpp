#include <gtest/gtest.h>

#include <boost/math/distributions/poisson.hpp>

#include "compile/compile_scene.h"
#include "reference/sampling/sampler.h"
#include "support/render_scene.h"
#include "support/rendering.h"
#include "support/sky_samples.h"

// scenes/gradient_sky.xml through the camera, against the formula of the sky in double for the same film positions.
namespace parhelion::test {
namespace {

constexpr glm::uvec2 kSize{64, 64};
constexpr std::uint32_t kSamples = 16;

const std::filesystem::path kScene = sceneFolder() / "gradient_sky.xml";

/// How far a camera ray's direction may be off: eight roundings of numbers up to 1, of a film position, its products
/// with the camera's vectors, their sums and the unit vector's.
constexpr double kDirectionError = 8 * 0x1p-24;

struct Expected {
    glm::dvec3 radiance{0};
    bool isAtRim = false;  ///< rounding decides whether a star is seen
};

/// What a camera ray in direction d must see: the formula, and every star looked at.
Expected radianceAlong(const SkyDescription& sky, const CompiledScene& scene, const glm::dvec3& d) {
    Expected expected{gradientFormula(sky, rawHeight(sky, d))};
    for (std::size_t i = 0; i < scene.stars.size(); i += 2) {
        const double chord = glm::distance(d, glm::dvec3(glm::vec3(scene.stars[i])));
        const double rim = std::sqrt(2 * double(scene.stars[i].w));
        if (chord <= rim) expected.radiance += double(scene.stars[i + 1].x) * sky.starRadiance;
        expected.isAtRim |= std::abs(chord - rim) <= kDirectionError;
    }
    return expected;
}

Expected expectedPixel(const SkyDescription& sky, const CompiledScene& scene, std::uint32_t pixel) {
    const shared::Camera& camera = scene.constants.camera;
    Expected mean;
    for (std::uint32_t sample = 0; sample < kSamples; ++sample) {
        const glm::uvec4 words = reference::draw(reference::pathKey(pixel, sample, 0, 0), 0, shared::kDrawCamera);
        const double x = pixel % kSize.x + reference::toUniform<double>(words.x);
        const double y = double(pixel / kSize.x) + reference::toUniform<double>(words.y);
        const glm::dvec3 d = glm::dvec3(camera.forward) + x * glm::dvec3(camera.dx) + y * glm::dvec3(camera.dy);
        const Expected one = radianceAlong(sky, scene, glm::normalize(d));
        mean.radiance += one.radiance / double(kSamples);
        mean.isAtRim |= one.isAtRim;
    }
    return mean;
}

struct PixelErrors {
    double largest = 0;      ///< of the pixels none of whose samples is at a star's rim
    std::size_t atRims = 0;  ///< the other pixels
    double expectedAtRims = 0;
};

PixelErrors pixelErrors(const std::map<std::string, std::string>& defines) {
    SceneReadOptions options;
    options.defines = defines;
    const SkyDescription sky = readScene(kScene, options).emitters.at(0).sky;
    const CompiledScene scene = compileFile(kScene, kSize, defines);
    RenderSettings settings = settingsFor(scene, kSamples);
    settings.quality.sobol = false;  // film positions are those of expectedPixel
    const Film film = renderVulkan(scene, settings);
    EXPECT_EQ(countAnomalies(film), 0u);
    PixelErrors errors;
    for (std::uint32_t pixel = 0; pixel < kSize.x * kSize.y; ++pixel) {
        const Expected expected = expectedPixel(sky, scene, pixel);
        const glm::dvec3 mean = sampleSum(film.pixels[pixel]) / double(kSamples);
        const glm::dvec3 error = glm::abs(mean - expected.radiance);
        errors.atRims += expected.isAtRim;
        if (!expected.isAtRim) errors.largest = std::max({errors.largest, error.x, error.y, error.z});
    }
    // Rings about circles of that radius, over the whole sphere.
    for (std::size_t i = 0; i < scene.stars.size(); i += 2)
        errors.expectedAtRims +=
            std::sqrt(2 * double(scene.stars[i].w)) * kDirectionError * double(kSamples) * kSize.x * kSize.y;
    return errors;
}

TEST(GradientSky, FollowsItsFormulaThroughTheCamera) {
    // The baseline is 1.59e-4 off. A direction's three roundings, the chord's 8 and those of the power and the film.
    const double largest = pixelErrors({{"density", "0"}}).largest;
    EXPECT_LE(largest, 2e-6);
    std::printf("gradient through the camera: largest error %.2g\n", largest);
}

TEST(GradientSky, ShowsEveryStarInItsPlace) {
    const PixelErrors errors = pixelErrors({});
    // Radiances up to 10, 16 of them: 16 roundings of 10. A star that were missed would be 1e-3 of a pixel or more.
    EXPECT_LE(errors.largest, 1e-5);
    // Few pixels are exempt: as many as chance puts there, at 1e-6.
    const boost::math::poisson distribution(errors.expectedAtRims);
    EXPECT_LE(double(errors.atRims), quantile(complement(distribution, 1e-6)));
}

}  // namespace
}  // namespace parhelion::test
