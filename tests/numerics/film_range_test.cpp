#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/film_image.h"
#include "reference/core/scene.h"
#include "reference/integrator/film.h"
#include "reference/reference_renderer.h"
#include "support/environment_maps.h"
#include "support/hand_scene.h"
#include "support/paths.h"
#include "support/render_scene.h"
#include "support/rendering.h"
#include "support/run_program.h"
#include "support/scene_reading.h"
#include "support/temporary_folder.h"

// Light of any size that a float can hold: nothing leaves the range of the film or of the image in silence.
namespace parhelion {
namespace {

using namespace test;

constexpr double kLargest = std::numeric_limits<float>::max();

/// A ball on a floor, half of it in fog, under a sky, a lamp and a textured light; brightest: 6.
SceneDescription litScene() {
    return readText(sceneXml(R"(<emitter type="sky"><rgb name="top" value="0.2, 0.4, 0.9"/></emitter>
<emitter type="point"><point name="position" x="2" y="3" z="1"/><rgb name="intensity" value="9, 8, 7"/></emitter>
<emitter type="directional"><vector name="direction" x="-0.6" y="-0.7" z="-0.3"/><rgb name="irradiance" value="3"/></emitter>
<shape type="rectangle"><transform name="to_world"><scale value="0.5"/><rotate x="1" angle="90"/><translate y="2"/></transform>
<emitter type="area"><texture name="radiance" type="checkerboard"><rgb name="color0" value="6, 5, 4"/>
<rgb name="color1" value="1, 2, 3"/></texture></emitter></shape>
<shape type="sphere"/>
<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale value="5"/><translate y="-1"/></transform>
</shape><shape type="cube"><transform name="to_world"><scale value="0.7"/><translate x="1.2" z="1.5"/></transform>
<bsdf type="null"/><medium type="homogeneous" name="interior"/></shape>)"));
}

/// All of its light times `factor`.
SceneDescription brightened(SceneDescription scene, double factor) {
    for (EmitterDescription& emitter : scene.emitters) {
        emitter.value *= factor;
        emitter.sky.bottom *= factor;
        emitter.sky.top *= factor;
        emitter.sky.starRadiance *= factor;
    }
    for (ShapeDescription& shape : scene.shapes)
        if (shape.radiance) *shape.radiance *= factor;
    return scene;
}

CompiledScene compiled(const SceneDescription& scene, glm::uvec2 size = {16, 12}) {
    CompileOptions options;
    options.size = size;
    return compileScene(scene, options);
}

/// Whether every value of an image is a number.
bool isFinite(const Image& image) {
    for (const auto& [name, values] : image.channels)
        for (const float value : values)
            if (!std::isfinite(value)) return false;
    return true;
}

// Light is linear: times a power of two, all bits of the image stay but for the exponents.
TEST(FilmRange, ImagesOfBrightenedScenesHaveTheSameDigits) {
    for (const Backend backend : kBackends) {
        const CompiledScene ordinary = compiled(litScene());
        EXPECT_EQ(ordinary.radianceUnit, 1.0);
        const Image expected = toImage(renderOn(backend, ordinary, 8));
        for (const int power : {-60, -40, 40, 60}) {
            if (backend == Backend::Vulkan && power != 60) continue;  // every film is a kernel to compile
            const double factor = std::exp2(power);
            const CompiledScene scene = compiled(brightened(litScene(), factor));
            // Of the point light alone, what is near may be 2^40 times as bright as what is far.
            EXPECT_EQ(scene.radianceUnit == 1.0, power == -40);
            RangeFaults faults;
            const Image image = toImage(renderOn(backend, scene, 8), &faults);
            for (const char* channel : {"R", "G", "B"}) {
                const std::vector<float>& exact = expected.channels.at(channel);
                const std::vector<float>& variance = expected.channels.at(std::string("variance.") + channel);
                std::size_t differ = 0, variancesDiffer = 0;
                for (std::size_t i = 0; i < exact.size(); ++i) {
                    differ += image.channels.at(channel)[i] != float(exact[i] * factor);
                    const double scaled = variance[i] * factor * factor;
                    if (scaled > 1.2e-38 && scaled < kLargest)
                        variancesDiffer += image.channels.at(std::string("variance.") + channel)[i] != float(scaled);
                }
                EXPECT_EQ(differ, 0u) << name(backend) << ", 2^" << power;
                EXPECT_EQ(variancesDiffer, 0u) << name(backend) << ", 2^" << power;
            }
            EXPECT_TRUE(isFinite(image));
            // Variances of the order of 2^120 / 8 and 2^-120 / 8 have room, but for the brightest and the darkest
            // pixels.
            EXPECT_FALSE(std::abs(power) <= 40 && faults.any()) << faults.above << ", " << faults.below;
        }
    }
}

// How bright a point light makes what is near does not depend on the size of the scene: a far thing behind the camera
// changes no digit of it.
TEST(FilmRange, PointLightsKeepTheirRangeWhateverIsFarAway) {
    const auto floorWith = [](double far) {
        const SceneDescription scene = readText(sceneXml(fmt::format(
            R"(<emitter type="point"><point name="position" x="0" y="1" z="0"/></emitter><shape type="rectangle">
<transform name="to_world"><rotate x="1" angle="-90"/></transform></shape><shape type="rectangle">
<transform name="to_world"><translate z="{}"/></transform></shape>)",
            far)));
        const Film film = renderOn(Backend::Reference, compiled(scene), 4);
        EXPECT_EQ(countAnomalies(film), 0u) << far;
        return toImage(film).channels.at("R");
    };
    const std::vector<float> expected = floorWith(1e3);
    EXPECT_GT(*std::ranges::max_element(expected), 0.01f);
    for (const double far : {1e6, 1e10, 1e13}) EXPECT_EQ(floorWith(far), expected) << far;
}

TEST(FilmRange, OneRadianceEverywhereIsExact) {
    for (const double radiance : {1e-40, 1e-38, 1e-30, 1e-20, 1e-15, 1e10, 1e15, 1e20, 1e30})
        for (const Backend backend : {Backend::Reference, Backend::Vulkan}) {
            if (backend == Backend::Vulkan && radiance != 1e-38 && radiance != 1e30) continue;
            SceneDescription scene = readText(sceneXml(R"(<emitter type="constant"/><shape type="sphere"/>)"));
            scene.shapes[0].bsdf.reflectance = glm::dvec3(1.0);  // a furnace
            RangeFaults faults;
            const Image image = toImage(renderOn(backend, compiled(brightened(scene, radiance), {6, 4}), 16), &faults);
            EXPECT_TRUE(isFinite(image));
            EXPECT_EQ(faults.above, 0u) << radiance;
            EXPECT_EQ(faults.below > 0, radiance < 1.2e-38) << radiance << ": " << faults.below;
            // A white ball's samples are products of a few floats; subnormal results have an absolute spacing instead.
            for (const float value : image.channels.at("G")) EXPECT_NEAR(value, radiance, 1e-5 * radiance + 2e-45);
            for (const float v : image.channels.at("variance.G"))
                EXPECT_LE(v, 0x1p-23 / 15 * radiance * radiance + 2e-45) << "each square is rounded by 2^-24 of itself";
        }
}

// Values of the image that 32 bits do not hold: bounded, counted, never infinite.
TEST(FilmRange, WhatTheImageCannotHoldIsCounted) {
    for (const double factor : {1e30, 1e-30}) {
        RangeFaults faults;
        const Image image = toImage(renderOn(Backend::Reference, compiled(brightened(litScene(), factor)), 4), &faults);
        EXPECT_TRUE(isFinite(image));
        EXPECT_EQ(faults.above > 0, factor > 1.0);
        EXPECT_EQ(faults.below > 0, factor < 1.0);
        for (const float v : image.channels.at("variance.R")) EXPECT_GE(v, 0.0f);
    }
}

TEST(FilmRange, MapsWithTexelsAtTheEndOfFloatStayNumbers) {
    SceneDescription scene = readText(sceneXml(R"(<shape type="sphere"/>)"));
    scene.emitters.push_back(madeMap({16, 8}, 0, false));
    for (unsigned i = 0; i < 128; i += 5) scene.emitters[0].map.texels[i] = glm::vec3(3e38f);
    for (const Backend backend : kBackends) {
        RangeFaults faults;
        const Film film = renderOn(backend, compiled(scene), 16);
        const Image image = toImage(film, &faults);
        EXPECT_TRUE(isFinite(image)) << name(backend);
        EXPECT_EQ(countAnomalies(film), 0u);
        EXPECT_GT(faults.above, 0u) << "variances of the order of 1e76";
    }
}

// What is no number, or has no square, is dropped and counted on both sides; the largest that has one is kept.
TEST(FilmRange, SamplesBeyondItAreDroppedAndCounted) {
    const float below = std::nextafter(shared::kLargestSample, 0.0f);
    const auto counted = [](glm::vec3 sample) {
        shared::FilmPixel pixel{};
        reference::Counters counters{};
        reference::accumulate(pixel, sample, true, counters);
        EXPECT_TRUE(std::isfinite(pixel.squareHigh.x + pixel.sumHigh.x));
        EXPECT_EQ(pixel.sumHigh.x, counters[shared::kCounterNonFinite] > 0 ? 0.0f : sample.x);
        return counters[shared::kCounterNonFinite];
    };
    EXPECT_EQ(counted({below, 0, 1}), 0u);
    for (const float bad : {shared::kLargestSample, 1e30f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
        EXPECT_EQ(counted({bad, 0, 1}), 1u);
        EXPECT_EQ(counted({1, 0, bad}), 1u);
        EXPECT_EQ(counted({1, -bad, 0}), 1u);
    }
    for (const Backend backend : kBackends)
        for (const float radiance : {below, shared::kLargestSample}) {
            HandScene hand;
            hand.lookAt({0, 0, 1}, {8, 4});
            hand.setEnvironment(glm::vec3(radiance));
            hand.scene.constants.environmentRadiance = glm::vec3(radiance);  // what the device reads of it
            hand.scene.effects = analyseEffects(hand.scene);
            const Film film = renderOn(backend, hand.scene, 2);
            EXPECT_EQ(film.counters[shared::kCounterNonFinite], radiance == below ? 0u : 64u) << name(backend);
        }
}

Film filmOf(const std::vector<float>& samples, double unit = 1.0) {
    Film film;
    film.filmSize = film.crop.size = {1, 1};
    film.samples = samples.size();
    film.radianceUnit = unit;
    film.pixels.resize(1, shared::FilmPixel{});
    reference::Counters counters{};
    for (std::size_t i = 0; i < samples.size(); ++i)
        reference::accumulate(film.pixels[0], glm::vec3(samples[i]), i == 0, counters);
    return film;
}

TEST(FilmRange, SumsBeyondFloatAreCounted) {
    RangeFaults faults;
    const Image image = toImage(filmOf(std::vector<float>(100, 9e18f)), &faults);
    EXPECT_EQ(image.channels.at("R")[0], 9e18f);
    EXPECT_EQ(image.channels.at("variance.R")[0], std::numeric_limits<float>::max());
    EXPECT_EQ(faults.above, 3u);
}

// Squares that are lost leave a bound of the variance, not 0.
TEST(FilmRange, LostSquaresLeaveABound) {
    for (const float size : {1e-17f, 1e-20f, 1e-30f}) {
        RangeFaults faults;
        const Image image = toImage(filmOf({size, 0, 0, 3 * size}), &faults);
        const double mean = size, exact = (10.0 / 4.0 - 1.0) * size * size / 3.0;
        EXPECT_NEAR(image.channels.at("R")[0], mean, 1e-6 * mean);
        EXPECT_GE(image.channels.at("variance.R")[0], exact * (1 - 1e-6));
        EXPECT_EQ(faults.below, 3u);
    }
    // Beside a bright pixel it makes no difference, and is no fault.
    Film film = filmOf({1e-20f, 0, 0, 3e-20f});
    film.filmSize = film.crop.size = {2, 1};
    film.pixels.push_back(filmOf({1, 2, 3, 4}).pixels[0]);
    RangeFaults faults;
    EXPECT_GT(toImage(film, &faults).channels.at("variance.R")[0], 0.0f);
    EXPECT_FALSE(faults.any());
}

TEST(FilmRange, DecidesTheProgramsExitCode) {
    const TemporaryFolder folder;
    const auto run = [&](const std::string& radiance, const std::string& extra) {
        const auto file =
            folder.write("scene.xml", sceneXml("<emitter type=\"constant\"><rgb name=\"radiance\" value=\"" + radiance +
                                               "\"/></emitter><shape type=\"sphere\"/>" + extra));
        return runProgram(programFile(),
                          {"render", file.string(), "-o", (folder.path() / "o.exr").string(), "--size", "4x4", "--spp",
                           "4", "--backend", "reference", "--json"},
                          folder.path());
    };
    const std::string lamp =
        R"(<emitter type="point"><point name="position" x="0.5" y="2" z="3"/><rgb name="intensity" value="9e29"/></emitter>)";
    EXPECT_EQ(run("1e20", "").exitCode, 0);
    const ProgramResult bright = run("1e30", lamp);
    EXPECT_EQ(bright.exitCode, 1);
    EXPECT_NE(bright.output.find("\"aboveRange\""), std::string::npos);
    EXPECT_NE(bright.error.find("scale the lights"), std::string::npos) << bright.error;
}

// A light that is far too faint beside another is dropped with a note that says so; a tint is not.
TEST(FilmRange, LightsBesideFarBrighterOnesAreNoted) {
    SceneDescription scene = litScene();
    scene.emitters[1].value = glm::dvec3(1e-20);
    scene.emitters[2].value = glm::dvec3(1e38);
    std::size_t notes = 0;
    for (const std::string& note : compiled(scene).notes) notes += note.find("too faint") != std::string::npos;
    EXPECT_EQ(notes, 1u);
}

}  // namespace
}  // namespace parhelion
