#include "image/film_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/core/scene.h"
#include "reference/integrator/film.h"

namespace parhelion {
namespace {

/// Rounding of a result to float32, relative.
constexpr double kRounding = 0x1p-24;

void addSample(shared::FilmPixel& pixel, const glm::vec3& sample) {
    reference::Counters counters{};
    reference::accumulate(pixel, sample, pixel.sumHigh == glm::vec3(0), counters);
}

Film onePixel(std::uint64_t samples) {
    Film film;
    film.filmSize = film.crop.size = {1, 1};
    film.samples = samples;
    film.pixels.resize(1, shared::FilmPixel{});
    return film;
}

TEST(FilmImage, MeanOfAMillionEqualSamplesIsExact) {
    // A naive float32 sum is 1 % off here (0.1) and 0.1 % (1/3).
    for (const float value : {0.1f, 1.0f / 3.0f, 1e-15f, 1e18f}) {
        Film film = onePixel(1'000'000);
        for (int i = 0; i < 1'000'000; ++i) addSample(film.pixels[0], glm::vec3(value, 0, 1));
        const Image image = toImage(film);
        // Kahan's sum is good to 2 * 2^-24 of itself before low is added; high + low to far less than one rounding.
        EXPECT_NEAR(image.channels.at("R")[0], value, kRounding * value * 2);
        EXPECT_EQ(image.channels.at("G")[0], 0.0f);
        EXPECT_EQ(image.channels.at("B")[0], 1.0f);
    }
}

TEST(FilmImage, SumIsHighPlusLow) {
    Film film = onePixel(3);
    film.pixels[0].sumHigh = glm::vec3(0x1p24f, 0, 0);
    film.pixels[0].sumLow = glm::vec3(-1, 0, 0);
    // 16777215 / 3 = 5592405 exactly; sumHigh alone gives 5592405.33, which rounds to 5592405.5.
    EXPECT_EQ(toImage(film).channels.at("R")[0], 5592405.0f);
}

TEST(FilmImage, MeanAndVarianceMatchDoublePrecision) {
    Film film = onePixel(4096);
    std::mt19937 random(3);
    std::exponential_distribution<float> exponential(0.7f);
    std::array<std::vector<double>, 3> samples;
    for (int i = 0; i < 4096; ++i) {
        const glm::vec3 sample{exponential(random), 100 + exponential(random), 1e-8f * exponential(random)};
        addSample(film.pixels[0], sample);
        for (int c = 0; c < 3; ++c) samples[c].push_back(sample[c]);
    }
    const Image image = toImage(film);
    for (int c = 0; c < 3; ++c) {
        const std::string name(1, "RGB"[c]);
        double sum = 0, squares = 0;
        for (const double x : samples[c]) sum += x;
        const double mean = sum / 4096;
        for (const double x : samples[c]) squares += (x - mean) * (x - mean);
        const double variance = squares / 4095 / 4096;
        EXPECT_NEAR(image.channels.at(name)[0], mean, 2 * kRounding * mean);
        // Each square is rounded by up to 2^-24 of itself, which E[x^2] - mean^2 turns into an absolute error; one more
        // 2^-24 covers the final rounding.
        EXPECT_NEAR(image.channels.at("variance." + name)[0], variance,
                    kRounding * ((mean * mean + variance * 4096) / 4095 + variance));
    }
}

TEST(FilmImage, VarianceIsNeverNegative) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(0.01f, 10.0f);
    int clamped = 0;
    for (int trial = 0; trial < 500; ++trial) {
        Film film = onePixel(64);
        const float value = uniform(random);
        for (int i = 0; i < 64; ++i) addSample(film.pixels[0], glm::vec3(value));
        const float variance = toImage(film).channels.at("variance.G")[0];
        ASSERT_GE(variance, 0.0f);
        ASSERT_LE(variance, kRounding * value * value / 63 * (1 + kRounding));
        clamped += variance == 0;
    }
    // About half of the squares round down: without the clamp those would be negative.
    EXPECT_GT(clamped, 100);
    EXPECT_LT(clamped, 400);
}

TEST(FilmImage, OneSampleHasNoVarianceAndNoneIsAnError) {
    const Image image = toImage(onePixel(1));
    EXPECT_FALSE(image.has("variance.R"));
    EXPECT_TRUE(image.has("R"));
    EXPECT_THROW(toImage(onePixel(0)), RuntimeFailure);
}

TEST(FilmImage, FeaturesAreMeansAndDepthIsOfHits) {
    Film film = onePixel(2);
    EXPECT_FALSE(toImage(film).has("depth.Z"));
    film.featureSamples = 4;
    film.features = {{.albedo = {1, 2, 3}, .depth = 30, .normal = {-4, 0, 2}, .hits = 3}};
    const Image image = toImage(film);
    EXPECT_EQ(image.channels.at("albedo.G")[0], 0.5f);
    EXPECT_EQ(image.channels.at("normal.X")[0], -1.0f);
    EXPECT_EQ(image.channels.at("normal.Z")[0], 0.5f);
    EXPECT_EQ(image.channels.at("depth.Z")[0], 10.0f);
    EXPECT_EQ(image.channels.at("sampleCount.Y")[0], 2.0f);
    film.features[0] = {};
    EXPECT_EQ(toImage(film).channels.at("depth.Z")[0], 0.0f);
}

TEST(FilmImage, CropKnowsItsPlaceOnTheFilm) {
    Film film;
    film.filmSize = {8, 6};
    film.crop = {.offset = {2, 1}, .size = {3, 2}};
    film.samples = 1;
    film.pixels.resize(6, shared::FilmPixel{});
    film.pixels[4].sumHigh = glm::vec3(5, 0, 0);
    const Image image = toImage(film);
    EXPECT_EQ(image.size, glm::uvec2(3, 2));
    EXPECT_EQ(image.channels.at("R"), (std::vector<float>{0, 0, 0, 0, 5, 0}));
    const std::map<std::string, Image::Attribute> expected{{"cropX", std::int64_t{2}},
                                                           {"cropY", std::int64_t{1}},
                                                           {"filmWidth", std::int64_t{8}},
                                                           {"filmHeight", std::int64_t{6}}};
    EXPECT_EQ(image.attributes, expected);
    film.crop = {.offset = {0, 0}, .size = {8, 6}};
    film.pixels.resize(48, shared::FilmPixel{});
    EXPECT_TRUE(toImage(film).attributes.empty());
}

}  // namespace
}  // namespace parhelion
