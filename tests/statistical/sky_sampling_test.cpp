#include <gtest/gtest.h>

#include <cmath>

#include "compile/compile_sky.h"
#include "compile/luminance.h"
#include "compile/star_field.h"
#include "reference/light/sky.h"
#include "support/goodness.h"
#include "support/hand_scene.h"
#include "support/sky_samples.h"
#include "support/words.h"

// Sampled points of the sky against the laws they must follow, and light sampling against scattering alone.
namespace parhelion::reference {
namespace {

using test::CellTest;
using test::HandScene;
using test::IndependentNumbers;
using test::partOf;

double significance() { return sidak(test::kFamilySignificance, 20); }

HandScene skyScene(const SkyDescription& sky) {
    HandScene scene;
    scene.setSky(sky);
    return scene;
}

/// Height and azimuth of a direction about an axis.
struct Polar {
    double cosine, turn;
};
Polar polarOf(const glm::dvec3& direction, const glm::dvec3& axis) {
    const Frame<double> frame = frameFromNormal(glm::normalize(axis));
    return {glm::dot(direction, frame.normal),
            test::turnOf(glm::dot(direction, frame.tangent), glm::dot(direction, frame.bitangent))};
}

/// Chances of 32 runs of bands, by the formula.
std::vector<double> bandChances(const SkyDescription& sky) {
    std::vector<double> chances(32, 0.0);
    double sum = 0;
    for (std::uint32_t band = 0; band < kSkyBands; ++band) {
        const double bound = std::max(luminance(test::gradientFormula(sky, band / double(kSkyBands))),
                                      luminance(test::gradientFormula(sky, (band + 1) / double(kSkyBands))));
        chances[band * 32 / kSkyBands] += bound;
        sum += bound;
    }
    for (double& chance : chances) chance /= sum;
    return chances;
}

TEST(SkySampling, BandsAreChosenByTheirBrightestDirection) {
    for (const double width : {0.75, 0.0}) {
        SkyDescription sky = test::starrySky();
        sky.starDensity = 0;
        sky.width = width;
        const HandScene built = skyScene(sky);
        const SceneView<float> view(built.scene);
        const glm::dvec3 axis(built.scene.constants.sky.axis);
        test::expectFitUnlessBent("bands", {0}, 0.02, [&](const glm::dvec4& bends) {
            CellTest cells(bandChances(sky), significance());
            IndependentNumbers numbers(1);
            for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
                const glm::dvec3 direction(sampleSky(view, numbers.words(bends)).direction);
                cells.add(partOf(0.5 + 0.5 * polarOf(direction, axis).cosine, 32));
            }
            return cells;
        });
    }
}

TEST(SkySampling, DirectionsAreUniformWithinTheirBand) {
    SkyDescription sky = test::starrySky();
    sky.starDensity = 0;
    const HandScene built = skyScene(sky);
    const SceneView<double> view(built.scene);
    test::expectFitUnlessBent("within bands", {0, 1}, 0.02, [&](const glm::dvec4& bends) {
        CellTest cells(36, significance());
        IndependentNumbers numbers(2);
        for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
            const glm::dvec3 axis(built.scene.constants.sky.axis);
            glm::uvec3 words(numbers.words({0, bends.y, 0, 0}));
            words.x = test::bentWithin(built.scene.distributions, words.x, bends.x);
            const Polar p = polarOf(sampleSky(view, words).direction, axis);
            const double place = (0.5 + 0.5 * p.cosine) * kSkyBands;
            cells.add(partOf(place - std::floor(place), 6) * 6 + partOf(p.turn, 6));
        }
        return cells;
    });
}

/// Share of the samples that pick a star: what the bands leave.
double starShare(const CompiledScene& scene) { return 1 - scene.distributions[kSkyBands].x * 0x1p-32; }

/// Stars alone: the gradient is black.
SkyDescription starsAlone(double size) {
    SkyDescription sky = test::starrySky(size);
    sky.bottom = sky.top = glm::dvec3(0);
    return sky;
}

TEST(SkySampling, StarsAreChosenByTheirBrightness) {
    const SkyDescription sky = starsAlone(2);
    const std::vector<Star> stars = scatterStars(sky);
    const HandScene built = skyScene(sky);
    const SceneView<float> view(built.scene);
    std::vector<double> chances(32, 0.0), even(32, 0.0);
    double sum = 0;
    for (const Star& star : stars) sum += star.brightness;
    for (std::size_t i = 0; i < stars.size(); ++i) {
        chances[i % 32] += stars[i].brightness / sum;
        even[i % 32] += 1.0 / double(stars.size());
    }
    CellTest cells(chances, significance()), defect(even, significance());
    IndependentNumbers numbers(3);
    for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
        const std::uint32_t star = sampleSky(view, numbers.words()).star;
        ASSERT_NE(star, kNone);
        cells.add(star % 32);
        defect.add(star % 32);
    }
    cells.expectFit("stars");
    defect.expectMisfit("stars chosen evenly");
}

TEST(SkySampling, DirectionsAreUniformWithinTheirStarHoweverSmall) {
    for (const double size : {1e-3, 0.01, 2.0}) {
        const HandScene built = skyScene(starsAlone(size));
        const SceneView<double> view(built.scene);  // floats have 150 steps across the smallest
        CellTest cells(18, significance()), tooWide(18, significance());
        IndependentNumbers numbers(4);
        for (std::uint64_t i = cells.samplesNeeded(); i > 0; --i) {
            const SkyPoint<double> point = sampleSky(view, numbers.words());
            const glm::vec4& disc = built.scene.stars[2 * point.star];
            const glm::dvec3 center = glm::normalize(glm::dvec3(glm::vec3(disc))), chord = point.direction - center;
            const double share = glm::dot(chord, chord) / (2 * double(disc.w));
            const std::size_t turn = partOf(polarOf(point.direction, center).turn, 3);
            cells.add(partOf(share, 6) * 3 + turn);
            tooWide.add(partOf(0.98 * share, 6) * 3 + turn);
        }
        cells.expectFit("star of " + std::to_string(size));
        tooWide.expectMisfit("cone off by 2 %");
    }
}

TEST(SkySampling, StarsTakeTheirShareOfTheSamples) {
    const SkyDescription sky = test::starrySky();
    const HandScene built = skyScene(sky);
    const SceneView<float> view(built.scene);
    // Those that lie in a star by chance, too: a disc's share of its bands.
    double share = starShare(built.scene);
    for (std::size_t i = 0; i < built.scene.stars.size(); i += 2) {
        const SkyPoint<double> center{glm::dvec3(built.scene.stars[i]), kNone};
        share += 2 * kPi<double> * built.scene.stars[i].w * skyPdf(SceneView<double>(built.scene), center);
    }
    CellTest cells({share, 1 - share}, significance()), defect({1.02 * share, 1 - 1.02 * share}, significance());
    IndependentNumbers numbers(5);
    for (std::uint64_t i = 4 * cells.samplesNeeded(); i > 0; --i) {
        const bool star = sampleSky(view, numbers.words()).star != kNone;
        cells.add(star ? 0 : 1);
        defect.add(star ? 0 : 1);
    }
    cells.expectFit("share");
    defect.expectMisfit("share off by 2 %");
}

TEST(SkySampling, DensityIntegratesToOne) {
    for (const double size : {1e-3, 0.1, 2.0})
        for (const double width : {0.0, 0.75}) {
            SkyDescription sky = test::starrySky(size);
            sky.width = width;
            const HandScene built = skyScene(sky);
            const SceneView<double> view(built.scene);
            const Frame<double> frame = frameFromNormal(glm::normalize(glm::dvec3(built.scene.constants.sky.axis)));
            double gradient = 0, stars = 0;
            constexpr int kPoints = 8 * int(kSkyBands);
            for (int i = 0; i < kPoints; ++i) {
                const double cosine = 2 * (i + 0.5) / kPoints - 1, sine = std::sqrt(1 - cosine * cosine);
                gradient += 4 * kPi<double> / kPoints *
                            skyPdf(view, SkyPoint<double>{toWorld(frame, glm::dvec3(sine, 0, cosine)), kNone});
            }
            for (std::uint32_t star = 0; 2 * star < built.scene.stars.size(); ++star) {
                const glm::vec4& disc = built.scene.stars[2 * star];
                const glm::dvec3 d = glm::normalize(glm::dvec3(glm::vec3(disc)));
                stars += 2 * kPi<double> * double(disc.w) *
                         (skyPdf(view, SkyPoint<double>{d, star}) - skyPdf(view, SkyPoint<double>{d, kNone}));
            }
            // Densities are floats.
            EXPECT_NEAR(gradient + stars, 1, 1e-6) << size;
            EXPECT_NEAR(stars, starShare(built.scene), 1e-6);
        }
}

// E[1 / pdf] is the solid angle of what has a density: 4 pi. It counts twice what two strategies find and the density
// forgets: the sampled density is that of the mixture.
TEST(SkySampling, DensityIsThatOfBothWaysToFindADirection) {
    const HandScene built = skyScene(test::starrySky());
    const SceneView<float> view(built.scene);
    RunningMoments moments, forgetful;
    IndependentNumbers numbers(6);
    for (int i = 0; i < 2'000'000; ++i) {
        const SkyPoint<float> point = sampleSky(view, numbers.words());
        moments.add(1 / double(skyPdf(view, point)));
        forgetful.add(1 / double(skyPdf(view, SkyPoint<float>{point.direction, kNone})));
    }
    test::expectResolvedMean(moments, 4 * kPi<double>, significance(), "solid angle");
    EXPECT_FALSE(test::agrees(forgetful, 4 * kPi<double>, significance()));
}

/// Irradiance of a floor with normal `up` from the gradient and from the stars, each by its formula.
glm::dvec3 irradiance(const SkyDescription& sky, const HandScene& built, const glm::dvec3& up) {
    constexpr int kHeights = 2000, kTurns = 400;
    const Frame<double> frame = frameFromNormal(up);
    glm::dvec3 sum(0);
    for (int i = 0; i < kHeights; ++i)
        for (int j = 0; j < kTurns; ++j) {
            const double cosine = (i + 0.5) / kHeights, sine = std::sqrt(1 - cosine * cosine);
            const double turn = 2 * kPi<double> * (j + 0.5) / kTurns;
            const glm::dvec3 d = toWorld(frame, glm::dvec3(sine * std::cos(turn), sine * std::sin(turn), cosine));
            sum += cosine * test::gradientFormula(sky, test::rawHeight(sky, d));
        }
    sum *= 2 * kPi<double> / (kHeights * kTurns);
    for (std::size_t i = 0; i < built.scene.stars.size(); i += 2) {
        // A cap's projection on the floor; the few that the horizon cuts are too low to count.
        const glm::vec4& disc = built.scene.stars[i];
        const double cap = kPi<double> * disc.w * (2 - disc.w) * glm::dot(glm::dvec3(glm::vec3(disc)), up);
        sum += std::max(0.0, cap) * double(built.scene.stars[i + 1].x) * sky.starRadiance;
    }
    return sum;
}

TEST(SkyLight, LightsAFloorAsItsIntegralSays) {
    for (const double size : {0.02, 2.0})
        for (const bool isSampled : {true, false}) {
            if (!isSampled && size < 1) continue;  // scattering alone hardly finds small stars
            SkyDescription sky = test::starrySky(size);
            sky.starRadiance *= std::pow(2 / size, 2);
            HandScene built = test::floorPatch();
            built.setSky(sky, isSampled);
            const double exact = 0.5 / kPi<double> * irradiance(sky, built, {0, 0, 1}).x;
            const test::PixelEstimate estimate = test::renderPixel(built.scene, 1'000'000);
            // Quadrature 1e-5; roundings.
            const double error = std::hypot(estimate.error, 2e-5 * exact);
            EXPECT_LT(std::abs(estimate.mean - exact) / error, twoSidedThreshold(significance()))
                << "size " << size << ", sampled " << isSampled << ": " << estimate.mean << " +- " << estimate.error
                << ", exact " << exact;
        }
}

TEST(SkyLight, ScatteringAloneAgreesInFog) {
    const auto fog = [](bool isSampled) {
        HandScene built = test::fogBox();
        built.setSky(test::starrySky(6), isSampled);
        return test::renderPixel(built.scene, 400'000);
    };
    const test::PixelEstimate both = fog(true), alone = fog(false);
    EXPECT_LT(std::abs(both.mean - alone.mean) / std::hypot(both.error, alone.error), twoSidedThreshold(significance()))
        << both.mean << " +- " << both.error << ", " << alone.mean << " +- " << alone.error;
    EXPECT_LT(both.error, alone.error);
}

}  // namespace
}  // namespace parhelion::reference
