#include "compile/compile_sky.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compile/luminance.h"
#include "compile/star_field.h"
#include "reference/light/sky.h"
#include "support/hand_scene.h"
#include "support/scene_reading.h"
#include "support/sky_samples.h"
#include "unit/compile_fixtures.h"

namespace parhelion {
namespace {

using test::HandScene;

CompiledScene compiled(const SkyDescription& sky) {
    SceneDescription description = fixtures::scene();
    EmitterDescription emitter;
    emitter.type = EmitterDescription::Type::Sky;
    emitter.sky = sky;
    description.emitters = {emitter};
    return compileScene(description);
}

SkyDescription gradient(const glm::dvec3& bottom, const glm::dvec3& top) {
    SkyDescription sky;
    sky.bottom = bottom;
    sky.top = top;
    return sky;
}

TEST(SkyReader, ReadsEveryPropertyAndItsDefault) {
    const SkyDescription plain = test::readText(test::sceneOf("<emitter type=\"sky\"/>")).emitters.at(0).sky;
    EXPECT_EQ(plain.axis, glm::dvec3(0, 1, 0));
    EXPECT_EQ(glm::dvec3(plain.offset, plain.width, plain.power), glm::dvec3(0, 1, 1));
    EXPECT_EQ(plain.bottom, glm::dvec3(0));
    EXPECT_EQ(plain.top, glm::dvec3(1));
    EXPECT_EQ(plain.starDensity, 0);
    const SkyDescription full = test::readText(test::sceneOf(R"(<emitter type="sky">
        <vector name="axis" x="0" y="0" z="-4"/><float name="offset" value="-0.3"/><float name="width" value="0.2"/>
        <float name="power" value="3"/><rgb name="bottom" value="1 2 3"/><rgb name="top" value="4 5 6"/>
        <float name="star_density" value="7"/><float name="star_size" value="0.5"/>
        <rgb name="star_radiance" value="8 9 10"/><integer name="star_seed" value="11"/></emitter>)"))
                                    .emitters.at(0)
                                    .sky;
    EXPECT_EQ(full.axis, glm::dvec3(0, 0, -1));
    EXPECT_EQ(glm::dvec3(full.offset, full.width, full.power), glm::dvec3(-0.3, 0.2, 3));
    EXPECT_EQ(full.bottom, glm::dvec3(1, 2, 3));
    EXPECT_EQ(full.top, glm::dvec3(4, 5, 6));
    EXPECT_EQ(glm::dvec3(full.starDensity, full.starSizeDegrees, full.starSeed), glm::dvec3(7, 0.5, 11));
    EXPECT_EQ(full.starRadiance, glm::dvec3(8, 9, 10));
}

TEST(CompiledSky, WithoutChangeIsAConstantEmitter) {
    SkyDescription equal = gradient({1, 2, 3}, {1, 2, 3}), powerless = gradient({0, 0, 0}, {1, 2, 3});
    powerless.power = 0;  // 0^0 is 1
    SkyDescription below = gradient({9, 9, 9}, {1, 2, 3});
    below.offset = 2;
    for (const SkyDescription& sky : {equal, powerless, below}) {
        const CompiledScene scene = compiled(sky);
        ASSERT_EQ(scene.constants.lightCount, 1u);
        EXPECT_EQ(scene.constants.lights[0].type, shared::kLightEnvironment);
        EXPECT_EQ(scene.constants.environmentRadiance, glm::vec3(1, 2, 3));
        EXPECT_FALSE(scene.effects.has(Effect::hasSky));
    }
}

TEST(CompiledSky, DropsWhatIsBlackWithANote) {
    SkyDescription sky = gradient({0, 0, 0}, {0, 0, 0});
    EXPECT_EQ(compiled(sky).constants.environment, shared::kNone);
    EXPECT_EQ(compiled(sky).notes.size(), 1u);
    SkyDescription powerless = gradient({1, 1, 1}, {0, 0, 0});  // 0^0 is 1: bottom is nowhere
    powerless.power = 0;
    powerless.width = 0.5;
    powerless.starDensity = 1e-4;  // not one
    powerless.starRadiance = glm::dvec3(1);
    EXPECT_EQ(compiled(powerless).constants.environment, shared::kNone);
    sky.top = {1, 1, 1};
    sky.starDensity = 5;
    sky.starRadiance = glm::dvec3(0);
    const CompiledScene scene = compiled(sky);
    EXPECT_EQ(scene.notes.size(), 1u);
    EXPECT_TRUE(scene.effects.has(Effect::hasSky));
    EXPECT_FALSE(scene.effects.has(Effect::hasStars));
}

TEST(CompiledSky, IsASampledEnvironment) {
    SkyDescription sky = test::starrySky();
    sky.starRadiance *= 100.0;
    const CompiledScene scene = compiled(sky);
    EXPECT_EQ(scene.constants.environment, 0u);
    EXPECT_EQ(scene.constants.lights[0].type, shared::kLightSky);
    EXPECT_EQ(scene.constants.lights[0].selection, 1.0f);
    EXPECT_EQ(scene.constants.environmentRadiance, glm::vec3(0));
    for (const Effect effect :
         {Effect::hasEnvironment, Effect::hasEnvironmentSampling, Effect::hasSky, Effect::hasStars})
        EXPECT_TRUE(scene.effects.has(effect));
}

TEST(CompiledSky, OfLowContrastIsLeftToScattering) {
    const SkyDescription linear = gradient({0, 0, 0}, {1, 1, 1});
    const CompiledScene smooth = compiled(linear);
    // Luminance uniform in [0, 1]: (1 / 3) / (1 / 4). Bands count by their largest value: up to 1 / 256 more of it.
    EXPECT_GE(skyContrast(linear, smooth), 4.0 / 3.0);
    EXPECT_LE(skyContrast(linear, smooth), 4.0 / 3.0 * (1.0 + 1.51 / kSkyBands));
    EXPECT_EQ(smooth.constants.lights[0].selection, 0.0f);
    EXPECT_FALSE(smooth.effects.has(Effect::hasEnvironmentSampling));

    SkyDescription spot = linear;
    spot.power = 1e5;
    EXPECT_EQ(compiled(spot).constants.lights[0].selection, 1.0f);
}

TEST(CompiledSky, ContrastCountsStars) {
    SkyDescription sky = gradient({1, 1, 1}, {1, 1, 1});
    sky.starDensity = 10;
    sky.starSizeDegrees = 2;
    sky.starRadiance = glm::dvec3(50);
    const CompiledScene scene = compiled(sky);
    double mean = 1, square = 1;
    for (std::size_t i = 0; i < scene.stars.size(); i += 2) {
        const double share = (1 - std::cos(std::numbers::pi / 180)) / 2, star = 50.0 * scene.stars[i + 1].x;
        mean += share * star;
        square += share * ((1 + star) * (1 + star) - 1);
    }
    EXPECT_NEAR(skyContrast(sky, scene), square / (mean * mean), 1e-5 * square);
}

TEST(CompiledSky, MeanRadianceIsTheIntegralOverTheSphere) {
    for (const double width : {0.0, 0.3, 1.0, 1e3, 1e9})
        for (const double power : {0.0, 0.2, 1.0, 3.0, 40.0, 1e5})
            for (const double offset : {0.0, 0.3, -0.7}) {
                SkyDescription sky = gradient({1, 2, 3}, {7, 1, 0});
                sky.width = width;
                sky.power = power;
                sky.offset = offset;
                CompiledScene scene;
                const glm::dvec3 mean = compileSky(sky, {}, scene);
                constexpr int kPoints = 2'000'000;
                double t = 0;
                for (int i = 0; i < kPoints; ++i)
                    t += (test::gradientFormula(sky, (i + 0.5) / kPoints).x - 1) / 6 / kPoints;
                // Midpoints: half a step at a jump, and 1e-6 where the power is steep against the step.
                EXPECT_NEAR(mean.x, 1 + 6 * t, 6e-6) << width << ' ' << power << ' ' << offset;
                EXPECT_NEAR(mean.y, 2 - t, 1e-6);
            }
}

TEST(CompiledSky, BandsAreAtLeastAsLikelyAsTheirBrightestDirection) {
    SkyDescription sky = test::starrySky();
    sky.starDensity = 0;
    for (const double width : {0.0, 0.01, 0.75}) {
        sky.width = width;
        CompiledScene scene;
        compileSky(sky, {}, scene);
        double ratio = 0, smallest = 1e30;  // of luminance to density: the bound, and how tight it is
        for (int i = 0; i <= 100'000; ++i) {
            const double raw = i / 100'000.0;
            const std::uint32_t band = std::min(std::uint32_t(raw * kSkyBands), kSkyBands - 1);
            const double now = luminance(test::gradientFormula(sky, raw)) / scene.skyBands[band];
            ratio = std::max(ratio, now);
            smallest = std::min(smallest, now);
        }
        double sum = 0, bounds = 0;
        for (std::uint32_t band = 0; band < kSkyBands; ++band) {
            sum += scene.skyBands[band];
            bounds += std::max(luminance(test::gradientFormula(sky, band / double(kSkyBands))),
                               luminance(test::gradientFormula(sky, (band + 1) / double(kSkyBands))));
        }
        EXPECT_NEAR(ratio, bounds / sum, 1e-5 * ratio) << "some direction is brighter than its band's bound";
        if (width > 0.5) {
            EXPECT_GT(smallest, 0.97 * ratio);
        }
    }
}

TEST(StarGrid, FindsWhatASearchOfAllStarsFinds) {
    struct Case {
        double size, density;
    };
    for (const auto [size, density] : {Case{10, 4}, Case{2, 40}, Case{0.2, 500}, Case{1e-3, 500}, Case{1e-3, 0.2}}) {
        SkyDescription sky = test::starrySky(size);
        sky.starDensity = density;
        HandScene built;
        built.setSky(sky);
        const reference::SceneView<float> view(built.scene);
        const std::size_t stars = built.scene.constants.sky.starCount;
        std::size_t found = 0;
        std::vector<glm::vec3> directions = test::skyDirections(built.scene, 100'000 / (1 + stars / 100));
        for (const glm::vec3& d : directions) {
            std::uint32_t expected = shared::kNone;
            for (std::uint32_t star = 0; star < stars; ++star) {
                const glm::vec4& disc = built.scene.stars[2 * star];
                const glm::vec3 chord = d - glm::vec3(disc);
                if (glm::dot(chord, chord) <= 2 * disc.w) expected = star;
            }
            ASSERT_EQ(reference::findStar(view, d), expected) << d.x << ' ' << d.y << ' ' << d.z;
            found += expected != shared::kNone;
        }
        EXPECT_GE(found, 3 * stars);
    }
}

TEST(StarGrid, HoldsAsManyStarsAsAreAllowed) {
    SkyDescription sky = test::starrySky(0.001);
    sky.starDensity = shared::kMaxStars / (4 * std::numbers::pi);
    CompiledScene scene;
    compileSky(sky, {}, scene);
    EXPECT_NEAR(scene.constants.sky.starCount, shared::kMaxStars, 6 * 512);
    EXPECT_LE(scene.constants.sky.starCount, shared::kMaxStars);
    const std::size_t cells = 6 * std::size_t(scene.constants.sky.starCells) * scene.constants.sky.starCells;
    for (std::size_t cell = 0; cell < cells; ++cell) {
        ASSERT_LE(scene.starCells[cell] & 15u, shared::kMaxStarsPerCell);
        ASSERT_LE((scene.starCells[cell] >> 4) + (scene.starCells[cell] & 15u), scene.starCells.size());
    }
    EXPECT_LT(scene.starCells.size(), 20 * scene.constants.sky.starCount);
}

}  // namespace
}  // namespace parhelion
