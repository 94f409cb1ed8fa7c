#include "compile/star_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/sky_samples.h"

namespace parhelion {
namespace {

TEST(StarField, IsTheSameForTheSameSeed) {
    const std::vector<Star> a = scatterStars(test::starrySky()), b = scatterStars(test::starrySky());
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].direction, b[i].direction);
        EXPECT_EQ(a[i].brightness, b[i].brightness);
    }
    SkyDescription other = test::starrySky();
    other.starSeed = 8;
    EXPECT_NE(scatterStars(other).front().direction, a.front().direction);
}

TEST(StarField, CountsAreThoseOfAPoissonProcess) {
    // Mean and variance of 2000 counts about 25.1: standard errors 0.11 and 0.8.
    SkyDescription sky = test::starrySky(0.01);
    sky.starDensity = 2;
    double sum = 0, squares = 0;
    constexpr int kSeeds = 2000;
    for (int seed = 0; seed < kSeeds; ++seed) {
        sky.starSeed = std::uint32_t(seed);
        const double count = double(scatterStars(sky).size());
        sum += count;
        squares += count * count;
    }
    const double mean = sum / kSeeds, variance = squares / kSeeds - mean * mean, exact = 8 * std::numbers::pi;
    EXPECT_NEAR(mean, exact, 5.5 * std::sqrt(exact / kSeeds));
    EXPECT_NEAR(variance, exact, 5.5 * exact * std::sqrt(2.1 / kSeeds));
}

TEST(StarField, DiscsDoNotOverlap) {
    for (const double size : {0.001, 2.0, 5.0}) {
        SkyDescription sky = test::starrySky(size);
        sky.starDensity = size == 5.0 ? 16 : 100;  // close to a tenth of the sky
        const std::vector<Star> stars = scatterStars(sky);
        const double least = 2 * std::sin(size * std::numbers::pi / 360);
        for (std::size_t i = 0; i < stars.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                ASSERT_GE(glm::distance(glm::dvec3(stars[i].direction), glm::dvec3(stars[j].direction)), least);
    }
}

// As dense as scenes may ask for, at every size: 0.6 of the attempts at least succeed.
TEST(StarField, FindsRoomWhereverTheLimitsAllowIt) {
    constexpr double kPi = std::numbers::pi;
    for (const double size : {0.34, 1.0, 3.0, 10.0}) {
        SkyDescription sky = test::starrySky(size);
        sky.starDensity = 0.1 / (4 * kPi * std::pow(std::sin(size * kPi / 720), 2));
        const double mean = 4 * kPi * sky.starDensity;
        EXPECT_NEAR(double(scatterStars(sky).size()), mean, 5.5 * std::sqrt(mean));
    }
}

// More than any packing holds (0.91 of the sphere), and less, but more than chance finds room for.
TEST(StarField, RefusesMoreStarsThanFindRoom) {
    for (const auto& [size, stars] : {std::pair(1.0, 20'000.0), {1.0, 80'000.0}, {10.0, 450.0}, {5.0, 200'000.0}}) {
        SkyDescription sky = test::starrySky(size);
        sky.starDensity = stars / (4 * std::numbers::pi);
        const double covered = stars * std::pow(std::sin(size * std::numbers::pi / 720), 2);
        try {
            scatterStars(sky, {.file = "night.xml", .line = 3, .column = 5});
            EXPECT_LT(covered, 0.4) << "room was found";
        } catch (const InputError& error) {
            EXPECT_GT(covered, 0.3);
            EXPECT_NE(std::string(error.what()).find("night.xml:3:5: sky: "), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find("leave no room"), std::string::npos) << error.what();
        }
    }
}

TEST(StarField, PlacesAndBrightnessFollowTheirLaws) {
    SkyDescription sky = test::starrySky(0.001);
    sky.starDensity = 10'000;
    const std::vector<Star> stars = scatterStars(sky);
    // Kolmogorov's distance of n values from their law is beyond 2.72 / sqrt(n) with probability 1e-6.
    const auto expectUniform = [&](auto value, const char* what) {
        std::vector<double> values;
        for (const Star& star : stars) values.push_back(value(star));
        std::ranges::sort(values);
        double worst = 0;
        for (std::size_t i = 0; i < values.size(); ++i)
            worst = std::max(worst, std::abs(values[i] - (double(i) + 0.5) / double(values.size())));
        EXPECT_LT(worst * std::sqrt(double(values.size())), 2.72) << what;
    };
    const double most = std::pow(kFaintestStar, -1.5);
    expectUniform([](const Star& star) { return 0.5 + 0.5 * double(star.direction.z); }, "z");
    expectUniform([](const Star& star) { return 0.5 + 0.5 * double(star.direction.x); }, "x");
    expectUniform([&](const Star& star) { return (std::pow(star.brightness, -1.5) - 1) / (most - 1); }, "brightness");
}

}  // namespace
}  // namespace parhelion
