#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "image/film_image.h"
#include "render/renderer.h"
#include "support/effect_scenes.h"
#include "support/gpu_fixture.h"
#include "support/render_scene.h"
#include "support/rendering.h"

// Film layers by number of scatterings.
namespace parhelion {
namespace {

using namespace test;

constexpr double kUlp = 0x1p-24;

std::string volpath(int depthLayers, int maxDepth) {
    return fmt::format(R"(<integrator type="volpath"><integer name="depth_layers" value="{}"/>
    <integer name="max_depth" value="{}"/><integer name="rr_depth" value="1000"/></integrator>)",
                       depthLayers, maxDepth);
}

/// A closed sphere around the camera that reflects `reflectance` and shines inwards with 2.
CompiledScene enclosure(double reflectance, int layers, glm::uvec2 size, int maxDepth = 40) {
    const std::string sphere = fmt::format(R"(<shape type="sphere"><float name="radius" value="9"/>
    <boolean name="flip_normals" value="true"/><bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf>
    <emitter type="area"><rgb name="radiance" value="2"/></emitter></shape>)",
                                           reflectance);
    return compileText(sceneXml(sphere, {.integrator = volpath(layers, maxDepth)}), size);
}

double layerMean(const Film& film, std::size_t pixel, std::uint32_t layer, int channel = 0) {
    const shared::LayerPixel& value = film.layers.at(pixel * film.depthLayers + layer);
    return (double(value.sumHigh[channel]) + double(value.sumLow[channel])) / double(film.samples);
}

double pixelMean(const Film& film, std::size_t pixel, int channel) {
    return sampleSum(film.pixels[pixel])[channel] / double(film.samples);
}

/// A path's contributions, at most 64 of them here, are added in float; each addition rounds by half an ulp of the sum.
void expectLayersSumToRadiance(const Film& film) {
    ASSERT_EQ(film.layers.size(), film.pixels.size() * film.depthLayers);
    double worst = 0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            double sum = 0;
            for (std::uint32_t layer = 0; layer < film.depthLayers; ++layer) sum += layerMean(film, i, layer, c);
            const double radiance = pixelMean(film, i, c);
            worst = std::max(worst, std::abs(sum - radiance) / std::max(radiance, 1e-6));
        }
    EXPECT_LE(worst, 64 * kUlp);
}

CompiledScene layeredScene() {
    const TemporaryFolder folder;
    for (NamedScene& named : effectScenes(folder, {40, 32}))
        if (named.name.starts_with("layers by depth")) return std::move(named.scene);
    throw std::logic_error("no scene with layers");
}

class DepthLayers : public testing::TestWithParam<Backend> {};

// Every path brings 2 r^k after k scatterings, the last layer 2 r^k / (1 - r) but for r^40. 40 bounces of 3 roundings.
TEST_P(DepthLayers, EnclosureHasItsGeometricSeries) {
    const double r = 0.5, tolerance = 120 * kUlp;
    const Film film = renderOn(GetParam(), enclosure(r, 5, {4, 4}), 64);
    ASSERT_EQ(film.depthLayers, 5u);
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        double running = 0;
        for (std::uint32_t k = 0; k < 4; ++k) {
            EXPECT_NEAR(layerMean(film, i, k), 2 * std::pow(r, k), 2 * tolerance) << k;
            running += layerMean(film, i, k);
            EXPECT_NEAR(running, 2 * (1 - std::pow(r, k + 1)) / (1 - r), 4 * tolerance) << k;
        }
        EXPECT_NEAR(layerMean(film, i, 4), 2 * std::pow(r, 4) / (1 - r), 4 * tolerance);
    }
}

// What light sampling finds has one scattering more than the path so far: a floor that sees a lamp and nothing else.
TEST_P(DepthLayers, SampledLightIsOneScatteringFurther) {
    const std::string body = R"(<shape type="rectangle"><transform name="to_world"><scale value="9"/></transform>
    <bsdf type="diffuse"/></shape><emitter type="point"><point name="position" x="0" y="0" z="2"/></emitter>)";
    const CompiledScene scene =
        compileText(sceneXml(body, {.origin = "0, 0, 1", .integrator = volpath(3, -1)}), {8, 8});
    const Film film = renderOn(GetParam(), scene, 8);
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        EXPECT_EQ(layerMean(film, i, 0), 0.0);
        EXPECT_GT(layerMean(film, i, 1), 0.01);
        EXPECT_EQ(layerMean(film, i, 2), 0.0);
    }
    expectLayersSumToRadiance(film);
}

TEST_P(DepthLayers, SumToTheRadianceAndLeaveItAsItIs) {
    CompiledScene scene = layeredScene();
    const Film film = renderOn(GetParam(), scene, 16);
    ASSERT_EQ(film.depthLayers, 3u);
    expectLayersSumToRadiance(film);
    for (std::uint32_t layer = 0; layer < 3; ++layer) {
        double total = 0;
        for (std::size_t i = 0; i < film.pixels.size(); ++i) total += layerMean(film, i, layer);
        EXPECT_GT(total, 0) << layer;
    }
    scene.constants.depthLayers = 0;
    scene.effects = analyseEffects(scene);
    ASSERT_FALSE(scene.effects.has(Effect::hasDepthLayers));
    const Film plain = renderOn(GetParam(), scene, 16);
    EXPECT_TRUE(plain.layers.empty());
    EXPECT_FALSE(toImage(plain).has("depth0.R"));
    EXPECT_EQ(countDifferentPixels(film, plain), 0u);
}

INSTANTIATE_TEST_SUITE_P(OnBothBackEnds, DepthLayers, testing::ValuesIn(kBackends),
                         [](const auto& info) { return name(info.param); });

// Paths are the same but for the few that rounding sends another way (parity/image_parity_test: 1e-5 of them); a pixel
// of 16 paths then differs with probability 2e-4, 0.26 of 1280 do on average, and more than 6 with a chance of 1e-8.
TEST(DepthLayersParity, DeviceFollowsTheReference) {
    const CompiledScene scene = layeredScene();
    const Film a = renderOn(Backend::Vulkan, scene, 16), b = renderOn(Backend::Reference, scene, 16);
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        bool same = true;
        for (std::uint32_t layer = 0; layer < 3; ++layer)
            for (int c = 0; c < 3; ++c)
                same = same && std::abs(layerMean(a, i, layer, c) - layerMean(b, i, layer, c)) <=
                                   1e-5 * (pixelMean(b, i, c) + 0.1);
        different += !same;
    }
    EXPECT_LE(different, 6u);
}

// More pixels than the software driver takes at once: two batches, each with layers of its own.
TEST(DepthLayersBatches, LayersFollowTheirPixels) {
    const CompiledScene scene = enclosure(0.25, 2, {512, 272}, 3);
    for (const bool isInterrupted : {false, true}) {
        RenderSettings settings = settingsFor(scene, 8);
        settings.featureSamples = 0;
        render::Renderer renderer(testDevice(), scene, settings);
        while (renderer.step())
            if (isInterrupted) renderer.finishEarly(60);
        const Film film = renderer.film();
        ASSERT_GT(film.samples, 0u);
        EXPECT_EQ(film.samples, isInterrupted ? film.samples : 8u);
        expectLayersSumToRadiance(film);
        for (const std::size_t i : {std::size_t(0), film.pixels.size() / 2, film.pixels.size() - 1})
            EXPECT_NEAR(layerMean(film, i, 0), 2, 1e-6) << isInterrupted;
    }
}

TEST(DepthLayersImage, ChannelsAreNamedByDepth) {
    Film film;
    film.filmSize = film.crop.size = {1, 1};
    film.samples = 2;
    film.pixels.resize(1);
    film.depthLayers = 2;
    film.layers = {{{2, 4, 6}, {}}, {{1, 1, 1}, {1, 1, 1}}};
    const Image image = toImage(film);
    EXPECT_EQ(image.channels.at("depth0.G").front(), 2.0f);
    EXPECT_EQ(image.channels.at("depth1.B").front(), 1.0f);
    EXPECT_FALSE(image.has("depth2.R"));
}

}  // namespace
}  // namespace parhelion
