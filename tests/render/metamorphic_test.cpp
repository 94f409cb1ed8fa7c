#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "analysis/statistics.h"
#include "image/image.h"
#include "render/renderer.h"
#include "support/effect_scenes.h"
#include "support/gpu_fixture.h"
#include "support/render_scene.h"
#include "support/run_program.h"

// Relations between images that hold without a reference: to the bit where the
// arithmetic is the same up to powers of two, and within the noise where it is another estimate of the same image.
namespace parhelion::test {
namespace {

constexpr glm::uvec2 kSize{24, 24};
constexpr double kSignificance = 1e-6;  // of each comparison, over its channels and tiles

const std::string kFog = R"(<medium type="homogeneous" id="fog"><rgb name="sigma_t" value="{0}"/>
    <rgb name="albedo" value="{1}"/><phase type="hg"><float name="g" value="0.5"/></phase></medium>
    <shape type="cube"><transform name="to_world"><scale value="{2}"/></transform><bsdf type="null"/>
    <ref name="interior" id="fog"/></shape>)";
const std::string kFloor = R"(<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/>
    <scale value="4"/><translate y="-1"/><scale value="{1}"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="{0}"/></bsdf></shape>)";
const std::string kSky = R"(<emitter type="constant"><rgb name="radiance" value="{}"/></emitter>)";
const std::string kSun = R"(<emitter type="directional"><vector name="direction" x="-0.6" y="-0.7" z="-0.3"/>
    <rgb name="irradiance" value="{}"/></emitter>)";
const std::string kLamp = R"(<shape type="sphere"><point name="center" x="-1.2" y="1.5" z="0.4"/>
    <float name="radius" value="0.3"/><emitter type="area"><rgb name="radiance" value="{}"/></emitter></shape>)";

template <typename... Values>
std::string fill(const std::string& pattern, const Values&... values) {
    return fmt::format(fmt::runtime(pattern), values...);
}

CompiledScene compiled(const std::string& body, const CompileOptions& options = {}) {
    return compileText(sceneXml(body), kSize, options);
}

/// A foggy corner under a lamp, the sun and the sky.
CompiledScene foggyScene() {
    return compiled(fill(kFloor, "0.7, 0.5, 0.3", 1) + fill(kFog, "1.5", "0.95, 0.9, 0.8", 0.9) +
                    fill(kLamp, "5, 6, 7") + fill(kSun, "2, 1.5, 1") + fill(kSky, "0.3, 0.4, 0.5"));
}

/// The cumulus under the sun and a lamp.
CompiledScene cloudScene() { return compileFile(sceneFolder() / "cloud_box.xml", kSize, {{"extinction", "20"}}); }

Film renderFilm(const CompiledScene& scene, std::uint64_t samples, std::uint32_t seed = 0,
                const std::function<void(RenderSettings&)>& change = {}) {
    RenderSettings settings = settingsFor(scene, samples, seed);
    if (change) change(settings);
    return renderVulkan(scene, settings);
}

/// Mean of a film's samples over a rectangle, one channel, with the variance of that mean.
struct Estimate {
    double mean = 0, variance = 0;
};

Estimate estimateOver(const Film& film, glm::uvec2 from, glm::uvec2 size, int channel) {
    Estimate estimate;
    const double n = double(film.samples), pixels = double(size.x) * size.y;
    for (unsigned y = from.y; y < from.y + size.y; ++y)
        for (unsigned x = from.x; x < from.x + size.x; ++x) {
            const shared::FilmPixel& pixel = film.pixels[y * film.crop.size.x + x];
            const double mean = sampleSum(pixel)[channel] / n;
            estimate.mean += mean / pixels;
            estimate.variance +=
                std::max(0.0, squareSum(pixel)[channel] / n - mean * mean) / ((n - 1) * pixels * pixels);
        }
    return estimate;
}

Film operator+(const Film& a, const Film& b) {
    Film sum = a;
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
        sum.pixels[i].sumHigh += b.pixels[i].sumHigh;
        sum.pixels[i].sumLow += b.pixels[i].sumLow;
        // Sums of independent films: variances add up, and so must E[x^2] - E[x]^2 of what stands for them.
        const glm::dvec3 cross = 2.0 * sampleSum(a.pixels[i]) * sampleSum(b.pixels[i]) / double(a.samples);
        sum.pixels[i].squareHigh = glm::vec3(squareSum(a.pixels[i]) + squareSum(b.pixels[i]) + cross);
        sum.pixels[i].squareLow = glm::vec3(0);
    }
    return sum;
}

/// Compares the means of the channels over the image and over its tiles of 8 x 8 pixels, split by Sidak. Prints the
/// relative bias of the image mean that would have been found 99 times in 100.
bool agree(const std::string& what, const Film& a, const Film& b) {
    const glm::uvec2 tiles = kSize / 8u;
    const double limit = twoSidedThreshold(sidak(kSignificance, 3 * (1 + tiles.x * tiles.y)));
    double worst = 0, power = 0;
    const auto add = [&](glm::uvec2 from, glm::uvec2 size, int channel) {
        const Estimate x = estimateOver(a, from, size, channel), y = estimateOver(b, from, size, channel);
        const double error = std::sqrt(x.variance + y.variance) + 1e-6 * y.mean;  // rounding, where nothing is random
        if (error > 0) worst = std::max(worst, std::abs(x.mean - y.mean) / error);
        if (size == kSize) power = std::max(power, detectableDeviation(limit) * error / y.mean);
    };
    for (int channel = 0; channel < 3; ++channel) {
        add({0, 0}, kSize, channel);
        for (unsigned t = 0; t < tiles.x * tiles.y; ++t) add({8 * (t % tiles.x), 8 * (t / tiles.x)}, {8, 8}, channel);
    }
    fmt::print("{:36} largest |z| {:4.2f}, limit {:4.2f}; finds {:.1f} % of the mean\n", what, worst, limit,
               100 * power);
    return worst <= limit;
}

constexpr std::uint64_t kBitSamples = 4, kSamples = 192;

TEST(Metamorphic, ScalingTheSceneByPowersOfTwoChangesNoBit) {
    const auto scaled = [](double s) {
        const std::string body = fill(kFloor, "0.7, 0.5, 0.3", s) + fill(kFog, 1.5 / s, "0.95, 0.9, 0.8", 0.9 * s) +
                                 fill(kSun, "2, 1.5, 1") + fill(kSky, "0.3, 0.4, 0.5");
        return compileText(sceneXml(body, {.origin = fmt::format("0, {}, {}", 0.5 * s, 5 * s)}), kSize);
    };
    const Film plain = renderFilm(scaled(1), kBitSamples);
    for (const double s : {0x1p-10, 0x1p10}) EXPECT_EQ(countDifferentPixels(plain, renderFilm(scaled(s), 4)), 0u) << s;
    EXPECT_GT(countDifferentPixels(plain, renderFilm(scaled(3), kBitSamples)), 0u);  // rounds differently
}

TEST(Metamorphic, BrighteningTheLightsByPowersOfTwoScalesTheFilmExactly) {
    const CompiledScene scene = foggyScene();
    const Film plain = renderFilm(scene, kBitSamples);
    for (const float s : {0x1p-10f, 0x1p10f}) {
        CompiledScene brighter = scene;
        for (std::uint32_t i = 0; i < scene.constants.lightCount; ++i) brighter.constants.lights[i].emission *= s;
        brighter.constants.environmentRadiance *= s;
        Film film = renderFilm(brighter, kBitSamples);
        for (shared::FilmPixel& pixel : film.pixels) {
            pixel.sumHigh /= s;
            pixel.sumLow /= s;
            pixel.squareHigh /= s * s;
            pixel.squareLow /= s * s;
            pixel.powerHigh /= glm::vec2(s, s * s);
            pixel.powerLow /= glm::vec2(s, s * s);
            pixel.third /= s * s * s;
            pixel.fourth /= s * s * s * s;
            pixel.pivot /= s;
            pixel.largest /= s;
        }
        EXPECT_EQ(countDifferentPixels(plain, film), 0u) << s;
    }
}

CompiledScene turnChannels(CompiledScene scene) {
    const auto turn = [](glm::vec3& v) { v = {v.y, v.z, v.x}; };
    shared::SceneConstants& c = scene.constants;
    for (shared::Shape& shape : scene.shapes) turn(shape.reflectance);
    for (std::uint32_t i = 0; i < scene.shapes.size() && i < shared::kMaxInlineShapes; ++i)
        turn(c.shapes[i].reflectance);
    for (std::uint32_t i = 0; i < c.lightCount; ++i) turn(c.lights[i].emission);
    for (std::uint32_t i = 0; i < c.mediumCount; ++i) turn(c.media[i].albedo), turn(c.media[i].sigmaRatio);
    turn(c.environmentRadiance);
    return scene;
}

/// Without the moments of the luminance, in which channels differ.
Film withoutMoments(Film film) {
    for (shared::FilmPixel& p : film.pixels) {
        p.powerHigh = p.powerLow = glm::vec2(0);
        p.third = p.fourth = p.pivot = p.largest = 0;
    }
    return film;
}

Film turnChannels(Film film) {
    for (shared::FilmPixel& p : film.pixels)
        for (glm::vec3* v : {&p.sumHigh, &p.sumLow, &p.squareHigh, &p.squareLow}) *v = {v->y, v->z, v->x};
    return film;
}

TEST(Metamorphic, TurningTheColoursTurnsTheImage) {
    const CompiledScene grey = foggyScene();
    EXPECT_EQ(countDifferentPixels(withoutMoments(turnChannels(renderFilm(grey, kBitSamples))),
                                   withoutMoments(renderFilm(turnChannels(grey), kBitSamples))),
              0u);
    CompiledScene chromatic = grey;
    chromatic.constants.media[0].sigmaRatio = {1.0f, 0.6f, 0.3f};
    chromatic.effects = analyseEffects(chromatic);
    EXPECT_TRUE(agree("colours turned, chromatic", turnChannels(renderFilm(chromatic, kSamples)),
                      renderFilm(turnChannels(chromatic), kSamples, 1)));
}

TEST(Metamorphic, LightsAddUp) {
    const std::string rest = fill(kFloor, "0.7, 0.5, 0.3", 1) + fill(kFog, "1.5", "0.95, 0.9, 0.8", 0.9);
    const std::string lamp = fill(kLamp, "5, 6, 7"), sun = fill(kSun, "2, 1.5, 1");
    const Film both = renderFilm(compiled(rest + lamp + sun), kSamples);
    const Film a = renderFilm(compiled(rest + lamp), kSamples, 1), b = renderFilm(compiled(rest + sun), kSamples, 2);
    EXPECT_TRUE(agree("two lights", both, a + b));
    EXPECT_FALSE(agree("two lights, one 5 % too bright", both,
                       a + renderFilm(compiled(rest + fill(kSun, "2.1, 1.58, 1.05")), kSamples, 2)));
}

TEST(Metamorphic, SamplingTheSkyChangesOnlyTheNoise) {
    CompileOptions options;
    options.sampleEveryLight = true;
    const std::string body =
        fill(kFloor, "0.7, 0.5, 0.3", 1) + fill(kFog, "1.5", "0.95, 0.9, 0.8", 0.9) + fill(kSky, "0.3, 0.4, 0.5");
    EXPECT_TRUE(
        agree("sky sampled", renderFilm(compiled(body, options), kSamples), renderFilm(compiled(body), kSamples, 1)));
}

TEST(Metamorphic, QualityChangesOnlyTheNoise) {
    const CompiledScene scene = cloudScene();
    const Film plain = renderFilm(scene, kSamples);
    for (const float roulette : {0.0f, 100.0f})
        EXPECT_TRUE(agree(fmt::format("shadow roulette {}", roulette), plain,
                          renderFilm(scene, kSamples, 1, [&](auto& s) { s.quality.shadowRoulette = roulette; })));
    EXPECT_TRUE(agree("trilinear density", plain,
                      renderFilm(scene, kSamples, 2, [](auto& s) { s.quality.stochasticFilter = false; })));
}

TEST(Metamorphic, PathRouletteChangesOnlyTheNoise) {
    CompiledScene early = foggyScene();
    const Film plain = renderFilm(early, kSamples);
    early.constants.rouletteDepth = 2;
    CompiledScene never = early;
    never.constants.rouletteDepth = 1u << 20;
    EXPECT_TRUE(agree("path roulette from 2 on", renderFilm(early, kSamples, 1), plain));
    EXPECT_TRUE(agree("no path roulette", renderFilm(never, kSamples, 2), plain));
}

TEST(Metamorphic, ABoxOfFogMayBeTwo) {
    const std::string medium = R"(<medium type="homogeneous" id="{}"><rgb name="sigma_t" value="1.5"/>
        <rgb name="albedo" value="0.9, 0.8, 0.7"/></medium>)";
    const std::string box = R"(<shape type="cube"><transform name="to_world"><scale x="{}"/><translate x="{}"/>
        </transform><bsdf type="null"/><ref name="interior" id="{}"/></shape>)";
    const std::string lights = fill(kSun, "2, 1.5, 1") + fill(kSky, "0.3, 0.4, 0.5");
    const CompiledScene one = compiled(lights + fill(medium, "a") + fill(box, 1, 0, "a"));
    const CompiledScene two =
        compiled(lights + fill(medium, "a") + fill(medium, "b") + fill(box, 0.5, -0.5, "a") + fill(box, 0.5, 0.5, "b"));
    EXPECT_TRUE(agree("box of fog split in two", renderFilm(one, kSamples), renderFilm(two, kSamples, 1)));
}

}  // namespace
}  // namespace parhelion::test
