#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <functional>

#include "image/image.h"
#include "render/renderer.h"
#include "support/gpu_fixture.h"
#include "support/paths.h"
#include "support/render_scene.h"
#include "support/run_program.h"

// A film depends on the scene, the seed and the samples alone: not on how the work is cut into turns, dispatches,
// crops, runs and vectors.
namespace parhelion::test {
namespace {

constexpr glm::uvec2 kSize{24, 20};
constexpr std::uint64_t kSamples = 4;

CompiledScene cloudScene(glm::uvec2 size = kSize) { return compileFile(sceneFolder() / "cloud_box.xml", size); }

TEST(Slicing, StepsPerEventChangeNoBit) {
    const CompiledScene scene = cloudScene();
    RenderSettings settings = settingsFor(scene, kSamples);
    const Film plain = renderVulkan(scene, settings);
    for (const std::uint32_t steps : {1u, 3u, 16u}) {
        settings.quality.stepsPerEvent = steps;
        EXPECT_EQ(countDifferentPixels(plain, renderVulkan(scene, settings)), 0u) << steps;
    }
    settings.seed = 1;
    EXPECT_GT(countDifferentPixels(plain, renderVulkan(scene, settings)), 0u);
}

TEST(Slicing, CropsAreTheSamePixels) {
    const CompiledScene scene = cloudScene();
    const Film whole = renderVulkan(scene, settingsFor(scene, kSamples));
    for (const PixelRect crop :
         {PixelRect{{8, 8}, {16, 8}}, PixelRect{{5, 3}, {11, 13}}, PixelRect{{23, 19}, {1, 1}}}) {
        CompiledScene part = scene;
        part.cropOffset = crop.offset;
        part.cropSize = crop.size;
        Film expected = whole;
        expected.pixels.clear();
        expected.features.clear();
        for (unsigned y = crop.offset.y; y < crop.offset.y + crop.size.y; ++y)
            for (unsigned x = crop.offset.x; x < crop.offset.x + crop.size.x; ++x) {
                expected.pixels.push_back(whole.pixels[y * kSize.x + x]);
                expected.features.push_back(whole.features[y * kSize.x + x]);
            }
        const Film film = renderVulkan(part, settingsFor(part, kSamples));
        EXPECT_EQ(countDifferentPixels(film, expected), 0u) << crop.size.x << " x " << crop.size.y;
        EXPECT_EQ(countDifferentFeatures(film, expected), 0u) << crop.size.x << " x " << crop.size.y;
    }
}

Film renderRange(const CompiledScene& scene, std::uint64_t first, std::uint64_t count) {
    RenderSettings settings = settingsFor(scene, count);
    settings.firstSample = first;
    return renderVulkan(scene, settings);
}

/// Pixels where whole is not a + b. Kahan's sums are good to 2 * 2^-24 of the sum of what they add: for all three films
/// together 2^-22 of the whole. Most samples, lost or taken twice, weigh far more.
std::size_t countUnequalSums(const Film& whole, const Film& a, const Film& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
        const glm::dvec3 sum = sampleSum(whole.pixels[i]);
        const glm::dvec3 difference = abs(sum - sampleSum(a.pixels[i]) - sampleSum(b.pixels[i]));
        count += any(greaterThan(difference, sum * 0x1p-22));
    }
    return count;
}

TEST(Slicing, RunsAddUp) {
    const CompiledScene scene = cloudScene();
    const Film whole = renderRange(scene, 0, 8), begin = renderRange(scene, 0, 3), end = renderRange(scene, 3, 5);
    EXPECT_EQ(countUnequalSums(whole, begin, end), 0u);
    EXPECT_GT(countUnequalSums(whole, begin, renderRange(scene, 4, 5)), whole.pixels.size() / 2);
}

// H76: 32 bits of sample index would repeat.
TEST(Slicing, SampleIndicesHave64Bits) {
    constexpr std::uint64_t kWrap = std::uint64_t(1) << 32;
    const CompiledScene scene = cloudScene();
    const Film first = renderRange(scene, 0, 1), wrapped = renderRange(scene, kWrap, 1);
    EXPECT_GT(countDifferentPixels(first, wrapped), first.pixels.size() / 2);
    EXPECT_EQ(countUnequalSums(renderRange(scene, kWrap - 1, 2), renderRange(scene, kWrap - 1, 1), wrapped), 0u);
}

// Pixels that stop where their paths happen to end would be biased towards short paths: all have the same samples, the
// ones that a shorter run would have taken.
TEST(Slicing, FinishingEarlyIsAShorterRun) {
    const CompiledScene scene = cloudScene();
    render::Renderer renderer(testDevice(), scene, settingsFor(scene, 1 << 20));
    for (int dispatch = 0; dispatch < 3; ++dispatch) ASSERT_TRUE(renderer.step());
    renderer.finishEarly(60);
    while (renderer.step()) {
    }
    const Film film = renderer.film();
    ASSERT_GT(film.samples, 0u);
    ASSERT_LT(film.samples, 1u << 20);
    EXPECT_EQ(film.counters[shared::kCounterPathsFinished], film.samples * film.pixels.size());
    EXPECT_EQ(countDifferentPixels(film, renderVulkan(scene, settingsFor(scene, film.samples))), 0u);
}

// However far pixels have run ahead of each other, and in how many batches: what is left of a render that is cut off is
// the film of a shorter one.
TEST(Slicing, BeingCutOffIsAShorterRun) {
    const std::string sky = R"(<emitter type="constant"/><shape type="sphere"/>)";
    for (const CompiledScene& scene : {cloudScene(), compileText(sceneXml(sky), {512, 264})}) {
        RenderSettings settings = settingsFor(scene, 1 << 20);
        render::Renderer renderer(testDevice(), scene, settings);
        // Until pixels differ beyond a snapshot.
        for (int dispatch = 0; dispatch < 12; ++dispatch) ASSERT_TRUE(renderer.step());
        renderer.finishEarly(0);
        EXPECT_FALSE(renderer.step());
        const Film film = renderer.film();
        ASSERT_GT(film.samples, 0u);
        // How much is given up is a matter of time: nothing, where all pixels stand alike.
        EXPECT_LE(film.samples * film.pixels.size(), film.counters[shared::kCounterPathsFinished]);
        EXPECT_TRUE(film.pixelSamples.empty());
        EXPECT_EQ(countDifferentPixels(film, renderVulkan(scene, settingsFor(scene, film.samples))), 0u);
    }
}

RenderSettings withControls(RenderSettings settings, const CompiledScene& scene) {
    settings.controls = chooseControlPixels(scene.cropSize, 5);
    return settings;
}

std::size_t countDifferentControls(const Film& a, const Film& b) {
    std::size_t different = a.controls.size() != b.controls.size();
    for (std::size_t i = 0; i < std::min(a.controls.size(), b.controls.size()); ++i)
        different += std::memcmp(&a.controls[i], &b.controls[i], sizeof(ControlPixel)) != 0;
    return different;
}

// Control pixels have samples of their own: neither those of the image nor each other's; the image is what it is
// without them.
TEST(Slicing, ControlPixelsLeaveTheImageAlone) {
    const CompiledScene scene = cloudScene();
    const RenderSettings settings = withControls(settingsFor(scene, kSamples), scene);
    const Film film = renderVulkan(scene, settings), plain = renderVulkan(scene, settingsFor(scene, kSamples));
    EXPECT_EQ(countDifferentPixels(film, plain), 0u);
    EXPECT_EQ(film.counters, plain.counters);
    ASSERT_EQ(film.controls.size(), settings.controls.pixels.size());
    std::size_t alike = 0, inCloud = 0;
    for (const ControlPixel& control : film.controls) {
        const glm::dvec3 own = sampleSum(film.pixels[control.pixel]);
        const glm::dvec3 first = sampleSum(control.runs[0]), second = sampleSum(control.runs[1]);
        alike += own == first || own == second || first == second;
        ++inCloud;
    }
    EXPECT_LT(alike, inCloud / 4) << "pixels of which all see nothing but sky may agree";
}

// However the work is cut, and on either back end: control pixels are as much a function of the scene as the image.
TEST(Slicing, ControlPixelsDoNotDependOnTheCut) {
    const CompiledScene scene = cloudScene({512, 264});  // two batches
    const RenderSettings settings = withControls(settingsFor(scene, 2), scene);
    const Film film = renderVulkan(scene, settings);
    RenderSettings endless = settings;
    endless.sampleCount = 1 << 20;
    render::Renderer renderer(testDevice(), scene, endless);
    renderer.setSampleCount(1);
    while (renderer.step()) {
    }
    EXPECT_EQ(renderer.setSampleCount(2), 2u);
    while (renderer.step()) {
    }
    const Film inRounds = renderer.film();
    EXPECT_EQ(inRounds.samples, 2u);
    EXPECT_EQ(countDifferentPixels(film, inRounds), 0u);
    EXPECT_EQ(countDifferentControls(film, inRounds), 0u);
}

/// Pixels whose sum is not that of `samples` ones.
std::size_t countOtherSums(const Film& film, const std::function<std::uint64_t(std::size_t)>& samples) {
    std::size_t others = 0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) others += film.pixels[i].sumHigh.x != float(samples(i));
    return others;
}

// H81: a film in two batches under a sky of radiance 1, whose sums are counts, stopped while the second batch
// is behind the first: each pixel is divided by what it holds, then and at the end.
TEST(Slicing, SamplesAreCountedPerPixelWhereverARenderStops) {
    const std::string sky = R"(<emitter type="constant"><float name="radiance" value="1"/></emitter>)";
    const CompiledScene scene = compileText(sceneXml(sky), {512, 264});
    RenderSettings settings = settingsFor(scene, 1 << 20);
    settings.featureSamples = 0;
    render::Renderer renderer(testDevice(), scene, settings);
    std::size_t sharedCountIsWrong = 0;
    bool stopped = false;
    while (renderer.step() && !stopped) {
        const Film film = renderer.film();
        if (film.pixelSamples.empty()) continue;
        ASSERT_EQ(countOtherSums(film, [&](std::size_t i) { return film.pixelSamples[i]; }), 0u);
        sharedCountIsWrong += countOtherSums(film, [&](std::size_t) { return film.samples; });  // the naive divisor
        // The first batch has finished its second window, the other has begun it.
        stopped = film.pixelSamples.back() > 4 && film.pixelSamples.back() < film.pixelSamples.front();
    }
    ASSERT_TRUE(stopped);
    EXPECT_GT(sharedCountIsWrong, 0u);
    renderer.finishEarly(60);
    while (renderer.step()) {
    }
    const Film film = renderer.film();
    ASSERT_LT(film.samples, settings.sampleCount);
    EXPECT_EQ(film.counters[shared::kCounterPathsFinished], film.samples * film.pixels.size());
    EXPECT_EQ(countOtherSums(film, [&](std::size_t) { return film.samples; }), 0u);
}

TEST(Slicing, VectorWidthsChangeNoBit) {
    ::unsetenv("LP_NATIVE_VECTOR_WIDTH");  // a device of this process has set it, and children would inherit it
    const TemporaryFolder folder;
    std::vector<Image> images;
    for (const std::string bits : {"256", "512"}) {
        const std::string scene = sceneFolder() / "cloud_box.xml", file = bits + ".exr";
        const ProgramResult result =
            runProgram(test::programFile(),
                       {"render", scene, "-o", file, "--size", "21x18", "--spp", "2", "--vector-bits", bits, "--quiet"},
                       folder.path());
        ASSERT_EQ(result.exitCode, 0) << result.error;
        images.push_back(readExr(folder.path() / file));
    }
    EXPECT_EQ(images[0].channels, images[1].channels);
}

}  // namespace
}  // namespace parhelion::test
