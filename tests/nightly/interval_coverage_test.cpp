// Do 95 % intervals of scenes hold 95 times in 100? 400 renders each: of so many samples, to an error, in so much time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <optional>

#include "analysis/stopping_rule.h"
#include "render/renderer.h"
#include "support/coverage.h"
#include "support/gpu_fixture.h"
#include "support/render_scene.h"

namespace parhelion::test {
namespace {

constexpr std::size_t kRenders = 400;
constexpr glm::uvec2 kSize{24, 16};

struct CoverageCase {
    const char* name;
    CompiledScene (*scene)();
    bool sobol;
    std::uint64_t samples;
    double error;    ///< a target, reached with some such number of samples
    double seconds;  ///< enough for some such number
};

void PrintTo(const CoverageCase& c, std::ostream* stream) { *stream << c.name; }

CompiledScene slab() { return compileFile(sceneFolder() / "two_density_slab.xml", kSize); }

CompiledScene furnace() {
    CompileOptions options;
    options.sampleEveryLight = true;
    return compileFile(sceneFolder() / "white_furnace.xml", kSize, {}, options);
}

/// A ball of cloud under a sun.
CompiledScene sunlitBall() {
    return compileText(sceneXml(R"(
<emitter type="directional"><vector name="direction" x="-1" y="-2" z="-1"/><rgb name="irradiance" value="3"/></emitter>
<emitter type="constant"><rgb name="radiance" value=".2, .3, .5"/></emitter>
<medium type="homogeneous" id="fog"><float name="sigma_t" value="4"/><float name="albedo" value=".9"/></medium>
<shape type="sphere"><float name="radius" value="2"/><bsdf type="null"/><ref name="interior" id="fog"/></shape>)"),
                       kSize);
}

/// A white room whose small bright lamp is found by chance alone.
CompiledScene fireflies() {
    CompiledScene scene = compileText(sceneXml(R"(
<emitter type="constant"><float name="radiance" value="1"/></emitter>
<shape type="rectangle"><transform name="to_world"><scale value="20"/><rotate x="1" angle="-90"/></transform>
    <bsdf type="diffuse"><float name="reflectance" value=".5"/></bsdf></shape>
<shape type="sphere"><point name="center" x="0" y="8" z="0"/><float name="radius" value=".3"/>
    <emitter type="area"><float name="radiance" value="2000"/></emitter></shape>)"),
                                      kSize);
    for (std::uint32_t i = 0; i < scene.constants.lightCount; ++i) scene.constants.lights[i].selection = 0;
    return scene;
}

const CoverageCase kCases[] = {
    {"Slab", slab, false, 256, 0.13, 0.5},
    {"Furnace", furnace, true, 256, 0.03, 0.5},
    {"SunlitBall", sunlitBall, false, 256, 0.05, 0.5},
    {"Fireflies", fireflies, true, 2048, 0.15, 0.5},
};

enum class Mode { Samples, Error, Time };
constexpr const char* kModes[] = {"OfSamples", "ToAnError", "InTime"};

/// Renders one after the other in one mode. One renderer a seed: a pipeline is compiled once, the driver keeps it.
Film renderIn(Mode mode, const CoverageCase& c, const CompiledScene& scene, std::uint32_t seed) {
    const bool isFixed = mode == Mode::Samples;
    render::Renderer renderer(testDevice(), scene,
                              settingsWithControls(scene, isFixed ? c.samples : kUnlimitedSamples, seed, c.sobol));
    if (mode == Mode::Time)
        renderer.setDeadline(std::chrono::steady_clock::now() + std::chrono::milliseconds(int(1000 * c.seconds)));
    const auto renderTo = [&](std::uint64_t samples) {
        if (mode == Mode::Error) renderer.setSampleCount(samples);
        while (renderer.step()) {
        }
        return renderer.filmSoFar();
    };
    if (mode != Mode::Error) return renderTo(0);
    ErrorMonitor monitor(ErrorNorm::Rms);
    follow(StoppingRule(c.error, 1u << 16), monitor, renderTo, [] { return 0.0; });
    return renderer.filmSoFar();
}

class NightlyIntervalCoverage : public testing::TestWithParam<CoverageCase> {};

// The truth is the mean of 400 renders of a fixed number of samples, whose own error is a twentieth of one's.
TEST_P(NightlyIntervalCoverage, Is95PerCent) {
    const CoverageCase& c = GetParam();
    const CompiledScene scene = c.scene();
    const std::vector<double> truth =
        meanLuminance([&](std::uint32_t seed) { return renderIn(Mode::Samples, c, scene, seed); }, 1'000'000, kRenders);
    for (const Mode mode : {Mode::Samples, Mode::Error, Mode::Time}) {
        const Coverage coverage =
            coverageOf([&](std::uint32_t seed) { return renderIn(mode, c, scene, seed); }, 1, kRenders, truth);
        fmt::print("{:11} {:9} {}\n", c.name, kModes[int(mode)], coverage.text());
        // 400 intervals of the image: within 93 to 97 % would fail one in ten good runs; 2.9 standard deviations.
        EXPECT_GE(coverage.ofImage(), 0.918) << kModes[int(mode)];
        EXPECT_LE(coverage.ofImage(), 0.982) << kModes[int(mode)];
        EXPECT_LT(std::abs(coverage.meanZ), 4.9) << kModes[int(mode)];
        ASSERT_GT(coverage.trusted, 0u) << kModes[int(mode)];
        EXPECT_GE(coverage.ofTrusted(), 0.93) << kModes[int(mode)];
        EXPECT_LE(coverage.ofTrusted(), 0.97) << kModes[int(mode)];
    }
}

INSTANTIATE_TEST_SUITE_P(Of, NightlyIntervalCoverage, testing::ValuesIn(kCases),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace parhelion::test
