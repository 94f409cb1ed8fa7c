#include "render_scene.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "compile/bake_clouds.h"
#include "reference/cloud_baker.h"
#include "render/renderer.h"
#include "scene/scene_description.h"
#include "support/gpu_fixture.h"
#include "support/paths.h"
#include "support/temporary_folder.h"

namespace parhelion::test {
namespace {

template <typename Pixel>
std::size_t countDifferent(std::span<const Pixel> a, std::span<const Pixel> b) {
    if (a.size() != b.size()) return std::max(a.size(), b.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += std::memcmp(&a[i], &b[i], sizeof(Pixel)) != 0;
    return count;
}

}  // namespace

std::filesystem::path sceneFolder() { return std::filesystem::path(projectFolder()) / "scenes"; }

std::vector<std::filesystem::path> sceneFiles() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(sceneFolder()))
        if (entry.path().extension() == ".xml") files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

std::string sceneXml(const std::string& body, const SceneFrame& frame) {
    return "<scene version=\"3.0.0\">\n" + frame.integrator + R"(
<sensor type="perspective">
    <float name="fov" value="40"/>
    <transform name="to_world"><lookat origin=")" +
           frame.origin + R"(" target="0, 0, 0" up="0, 1, 0"/></transform>
    <sampler type="independent"/>
    <film type="hdrfilm"><rfilter type=")" +
           frame.filter + "\"/></film>\n</sensor>\n" + body + "\n</scene>\n";
}

CompiledScene compileFile(const std::filesystem::path& file, glm::uvec2 size,
                          const std::map<std::string, std::string>& defines, CompileOptions options) {
    options.size = size;
    SceneDescription description = readScene(file, {.defines = defines});
    bakeClouds(description, {.bake = reference::bakeCloud<float>, .evaluate = {}});
    return compileScene(description, options);
}

CompiledScene compileText(const std::string& text, glm::uvec2 size, CompileOptions options) {
    const TemporaryFolder folder;
    options.size = size;
    return compileScene(readScene(folder.write("scene.xml", text)), options);
}

RenderSettings settingsFor(const CompiledScene& scene, std::uint64_t samples, std::uint32_t seed) {
    RenderSettings settings;
    settings.sampleCount = samples;
    settings.seed = seed;
    settings.featureSamples = 1;
    settings.effects = scene.effects;
    return settings;
}

Film renderVulkan(const CompiledScene& scene, const RenderSettings& settings) {
    return render::render(testDevice(), scene, settings);
}

glm::dvec3 sampleSum(const shared::FilmPixel& pixel) { return glm::dvec3(pixel.sumHigh) + glm::dvec3(pixel.sumLow); }

glm::dvec3 squareSum(const shared::FilmPixel& pixel) {
    return glm::dvec3(pixel.squareHigh) + glm::dvec3(pixel.squareLow);
}

std::size_t countDifferentPixels(const Film& a, const Film& b) {
    return countDifferent<shared::FilmPixel>(a.pixels, b.pixels);
}

std::size_t countDifferentFeatures(const Film& a, const Film& b) {
    return countDifferent<shared::FeaturePixel>(a.features, b.features);
}

}  // namespace parhelion::test
