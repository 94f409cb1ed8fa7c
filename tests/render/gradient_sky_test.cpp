#include <gtest/gtest.h>

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

/// What a camera ray in direction d must see: the formula, and every star looked at.
glm::dvec3 radianceAlong(const SkyDescription& sky, const CompiledScene& scene, const glm::dvec3& d) {
    glm::dvec3 radiance = gradientFormula(sky, rawHeight(sky, d));
    for (std::size_t i = 0; i < scene.stars.size(); i += 2) {
        const glm::dvec3 chord = d - glm::dvec3(glm::vec3(scene.stars[i]));
        if (glm::dot(chord, chord) <= 2 * double(scene.stars[i].w))
            radiance += double(scene.stars[i + 1].x) * sky.starRadiance;
    }
    return radiance;
}

glm::dvec3 expectedPixel(const SkyDescription& sky, const CompiledScene& scene, std::uint32_t pixel) {
    const shared::Camera& camera = scene.constants.camera;
    glm::dvec3 sum(0);
    for (std::uint32_t sample = 0; sample < kSamples; ++sample) {
        const glm::uvec4 words = reference::draw(reference::pathKey(pixel, sample, 0, 0), 0, shared::kDrawCamera);
        const double x = pixel % kSize.x + reference::toUniform<double>(words.x);
        const double y = double(pixel / kSize.x) + reference::toUniform<double>(words.y);
        const glm::dvec3 d = glm::dvec3(camera.forward) + x * glm::dvec3(camera.dx) + y * glm::dvec3(camera.dy);
        sum += radianceAlong(sky, scene, glm::normalize(d));
    }
    return sum / double(kSamples);
}

/// Largest errors of the pixels, sorted from large to small.
std::vector<double> pixelErrors(const std::map<std::string, std::string>& defines) {
    SceneReadOptions options;
    options.defines = defines;
    const SkyDescription sky = readScene(kScene, options).emitters.at(0).sky;
    const CompiledScene scene = compileFile(kScene, kSize, defines);
    RenderSettings settings = settingsFor(scene, kSamples);
    settings.quality.sobol = false;  // film positions are those of expectedPixel
    const Film film = renderVulkan(scene, settings);
    EXPECT_EQ(countAnomalies(film), 0u);
    std::vector<double> errors;
    for (std::uint32_t pixel = 0; pixel < kSize.x * kSize.y; ++pixel) {
        const glm::dvec3 mean = sampleSum(film.pixels[pixel]) / double(kSamples);
        const glm::dvec3 error = glm::abs(mean - expectedPixel(sky, scene, pixel));
        errors.push_back(std::max({error.x, error.y, error.z}));
    }
    std::ranges::sort(errors, std::greater{});
    return errors;
}

TEST(GradientSky, FollowsItsFormulaThroughTheCamera) {
    // The baseline is 1.59e-4 off. A direction's three roundings, the chord's 8 and those of the power and the film.
    const std::vector<double> errors = pixelErrors({{"density", "0"}});
    EXPECT_LE(errors.front(), 2e-6);
    std::printf("gradient through the camera: largest error %.2g\n", errors.front());
}

TEST(GradientSky, ShowsEveryStarInItsPlace) {
    const std::vector<double> errors = pixelErrors({});
    // A sample within rounding of a rim may see the star or not: at most 1 in 1e6 of them (20 000 stars of radius 1e-3,
    // rims 3e-7 wide). Wherever a star was missing, the error would be above 1e-3 of a pixel.
    EXPECT_LE(errors.at(3), 1e-5);
}

}  // namespace
}  // namespace parhelion::test
