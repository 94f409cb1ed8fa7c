#include <gtest/gtest.h>

#include "reference/sampling/sampler.h"
#include "support/environment_maps.h"
#include "support/render_scene.h"
#include "support/rendering.h"
#include "support/shared_data.h"

// Environment maps through the camera, against the definition of the map in double for the same film positions.
namespace parhelion::test {
namespace {

constexpr glm::uvec2 kSize{64, 64};
constexpr std::uint32_t kSamples = 4;

/// Worst error of the pixels, beyond what roundings of the directions explain, in units of the radiance.
double worstError(const std::string& text, const EmitterDescription& map) {
    const CompiledScene scene = compileText(text, kSize);
    RenderSettings settings = settingsFor(scene, kSamples);
    settings.quality.sobol = false;
    const Film film = renderVulkan(scene, settings);
    EXPECT_EQ(countAnomalies(film), 0u);
    const shared::Camera& camera = scene.constants.camera;
    double worst = 0;
    for (std::uint32_t pixel = 0; pixel < kSize.x * kSize.y; ++pixel) {
        ColourRange sum{glm::dvec3(0), glm::dvec3(0)};
        for (std::uint32_t sample = 0; sample < kSamples; ++sample) {
            const glm::uvec4 words = reference::draw(reference::pathKey(pixel, sample, 0, 0), 0, shared::kDrawCamera);
            const double x = pixel % kSize.x + reference::toUniform<double>(words.x);
            const double y = double(pixel / kSize.x) + reference::toUniform<double>(words.y);
            const glm::dvec3 d = glm::dvec3(camera.forward) + x * glm::dvec3(camera.dx) + y * glm::dvec3(camera.dy);
            const ColourRange range = mapRange(map, glm::normalize(d), 12);  // 4 more of the camera's direction
            sum.low += range.low / double(kSamples);
            sum.high += range.high / double(kSamples);
        }
        const glm::dvec3 mean = sampleSum(film.pixels[pixel]) / double(kSamples);
        for (int c = 0; c < 3; ++c) {
            const double nearest = std::clamp(mean[c], sum.low[c], sum.high[c]);
            worst = std::max(worst, std::abs(mean[c] - nearest) / std::max(nearest, 1e-6));
        }
    }
    return worst;
}

std::string sceneLooking(const std::string& direction, const std::string& up, const std::string& file) {
    return "<scene version=\"3.0.0\"><integrator type=\"path\"/><sensor type=\"perspective\"><float name=\"fov\" "
           "value=\"90\"/><transform name=\"to_world\"><lookat origin=\"0 0 0\" target=\"" +
           direction + "\" up=\"" + up +
           "\"/></transform><film type=\"hdrfilm\"><rfilter type=\"box\"/></film></sensor><emitter "
           "type=\"envmap\"><string name=\"filename\" value=\"" +
           file + "\"/></emitter></scene>";
}

/// The six directions of a cube's faces.
void expectMapFromSixDirections(const std::filesystem::path& file) {
    EmitterDescription map;
    map.map = readBitmap(file, {});
    for (const char* direction : {"1 0 0", "-1 0 0", "0 0 1", "0 0 -1"})
        EXPECT_LE(worstError(sceneLooking(direction, "0 1 0", file.string()), map), 1e-5) << direction;
    for (const char* direction : {"0 1 0", "0 -1 0"})
        EXPECT_LE(worstError(sceneLooking(direction, "0 0 1", file.string()), map), 1e-5) << direction;
}

TEST(EnvironmentRender, ShowsTheMapInSixDirections) {
    expectMapFromSixDirections(sceneFolder() / "environments/afternoon.hdr");
}

TEST(EnvironmentRender, ShowsTheLabelsOfAnOrientationMapWhereTheyBelong) {
    const std::filesystem::path file = sharedFile("data/environments/OrientationLatLong.exr");
    if (file.empty()) GTEST_SKIP() << "../shared/data/environments is missing";
    expectMapFromSixDirections(std::filesystem::absolute(file));
}

}  // namespace
}  // namespace parhelion::test
