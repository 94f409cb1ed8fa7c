// shaders/integrator/film.glsl against sums in double precision.
#include "reference/integrator/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/gpu_fixture.h"
#include "support/parity_report.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::Parity;

constexpr std::size_t kRows = 9;  // of an item, of parity/film.comp

/// Sum of value * (1, 2, 3, 1, 2, 3, ...) as the device forms the summands, and of their squares, in double.
glm::dvec2 exactSums(float value, int count) {
    glm::dvec2 sums(0);
    for (int i = 0; i < count; ++i) {
        const float summand = value * float(1 + i % 3);
        sums += glm::dvec2(summand, double(summand * summand));
    }
    return sums;
}

/// Adds `count` samples of values[i].xyz to pixel i: rows as parity/film.comp returns them.
std::vector<glm::vec4> accumulateOnDevice(const std::vector<glm::vec3>& values, int count) {
    constexpr int kAtOnce = 60'000;  // the software driver ends loops after 65535 turns
    std::vector<glm::vec4> rows(kRows * values.size(), glm::vec4(0));
    for (int done = 0; done < count; done += kAtOnce) {
        for (std::size_t i = 0; i < values.size(); ++i) rows[kRows * i] = {values[i], std::min(kAtOnce, count - done)};
        rows = test::probe("parity/film.comp", 0, rows, kRows, kRows);
    }
    return rows;
}

// H77: a million equal samples; H80: the compensation is not optimised away on the device.
TEST(FilmParity, MillionSamplesKeepTheirDigitsH77H80) {
    constexpr int kCount = 1'020'000;
    const std::vector<glm::vec3> values{{0.1f, 1.0f / 3, 1e-6f}, {1e5f, 0.7f, 0.0f}};
    const auto rows = accumulateOnDevice(values, kCount);
    // Kahan 1965: 2 roundings, whatever the number of summands, but for n 2^-48 of their sum.
    constexpr double kAllowed = 2 + kCount * 0x1p-24;
    Parity film("integrator/film", "accumulate", kAllowed);
    test::ErrorMeter naive;
    for (std::size_t i = 0; i < values.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const glm::dvec2 exact = exactSums(values[i][c], kCount);
            EXPECT_TRUE(film.near(double(rows[kRows * i + 1][c]) + rows[kRows * i + 2][c], exact.x))
                << i << ", channel " << c;
            EXPECT_TRUE(film.near(double(rows[kRows * i + 3][c]) + rows[kRows * i + 4][c], exact.y))
                << i << ", channel " << c;
            naive.add(rows[kRows * i + 5][c], exact.x);
        }
    EXPECT_GT(naive.worst(), 100 * kAllowed);
}

// The reference in float takes the same steps: to the bit.
TEST(FilmParity, ReferenceInFloatAgreesToTheBit) {
    constexpr int kCount = 1'000;
    const glm::vec3 value(0.1f, 1.0f / 3, 1e-6f);
    const auto rows = accumulateOnDevice({value}, kCount);
    shared::FilmPixel pixel{};
    reference::Counters counters{};
    for (int i = 0; i < kCount; ++i) reference::accumulate<float>(pixel, value * float(1 + i % 3), i == 0, counters);
    Parity parity("integrator/film", "accumulate", 0);
    EXPECT_TRUE(parity.near(rows[1], pixel.sumHigh));
    EXPECT_TRUE(parity.near(rows[2], pixel.sumLow));
    EXPECT_TRUE(parity.near(rows[3], pixel.squareHigh));
    EXPECT_TRUE(parity.near(rows[4], pixel.squareLow));
    EXPECT_TRUE(parity.near(rows[6], glm::vec3(pixel.powerHigh, pixel.powerLow.x)));
    EXPECT_TRUE(parity.near(glm::vec3(rows[6].w, rows[7].x, 0), glm::vec3(pixel.powerLow.y, pixel.third, 0)));
    EXPECT_TRUE(parity.near(glm::vec3(rows[8]), glm::vec3(pixel.fourth, pixel.pivot, pixel.largest)));
}

TEST(FilmParity, OneCompensatedSumAgreesToTheBit) {
    std::vector<glm::vec4> inputs;
    test::Stress stress(23);
    for (int i = 0; i < 2'000; ++i) {
        const float size = stress.magnitude(1e-3f, 1e9f);
        inputs.emplace_back(stress.point(stress.magnitude(1e-5f, 1e5f)), 0);
        inputs.emplace_back(stress.point(size), 0);
        inputs.emplace_back(stress.point(size * 0x1p-24f), 0);
        inputs.resize(inputs.size() + kRows - 3, glm::vec4(0));
    }
    const auto rows = test::probe("parity/film.comp", 0, inputs, kRows, kRows);
    Parity parity("integrator/film", "addCompensated", 0);
    for (std::size_t i = 0; i < rows.size(); i += kRows)
        for (int c = 0; c < 3; ++c) {
            float high = inputs[i + 1][c], low = inputs[i + 2][c];
            reference::addCompensated<float>(high, low, inputs[i][c]);
            EXPECT_TRUE(parity.near(rows[i][c], high)) << i;
            EXPECT_TRUE(parity.near(rows[i + 1 + std::size_t(c)].w, low)) << i;
        }
}

TEST(FilmParity, LuminanceAgreesToTheBit) {
    std::vector<glm::vec4> inputs;
    test::Stress stress(29);
    for (int i = 0; i < 1'000; ++i) {
        inputs.emplace_back(glm::abs(stress.point(stress.magnitude(1e-9f, 1e9f))), 0);
        inputs.resize(inputs.size() + kRows - 1, glm::vec4(0));
    }
    const auto rows = test::probe("parity/film.comp", 0, inputs, kRows, kRows);
    Parity parity("integrator/film", "luminance", 0);
    for (std::size_t i = 0; i < rows.size(); i += kRows)
        EXPECT_TRUE(parity.near(rows[i + 7].w, reference::luminance<float>(glm::vec3(inputs[i]))));
}

/// Sums of the powers of what a sample's luminance is above the first one's, in double.
struct ExactPowers {
    double sums[4] = {0, 0, 0, 0};
    float pivot = 0;

    void add(float y, bool first) {
        if (first) pivot = y;
        double power = 1;
        for (double& sum : sums) sum += power *= double(y) - pivot;
    }
};

// Powers about the first sample: of samples that hardly differ, and of a million, they keep their digits.
TEST(FilmParity, PowersKeepTheirDigitsH77) {
    constexpr int kCount = 60'000;
    for (const float spread : {1.0f, 1e-3f}) {
        shared::FilmPixel pixel{};
        reference::Counters counters{};
        ExactPowers exact;
        double naive = 0, squares = 0, sum = 0;
        for (int i = 0; i < 20 * kCount; ++i) {
            const glm::vec3 value(1 + spread * float(i % 7) / 7);
            reference::accumulate<float>(pixel, value, i == 0, counters);
            const float y = reference::luminance<float>(value);
            exact.add(y, i == 0);
            sum += y;
            squares += double(y * y);
        }
        naive = squares - sum * sum / (20 * kCount);
        for (int k = 0; k < 2; ++k)
            EXPECT_NEAR((double(pixel.powerHigh[k]) + pixel.powerLow[k]) / exact.sums[k], 1, 1e-6) << k << spread;
        EXPECT_NEAR(pixel.third / exact.sums[2], 1, 0.05) << spread;
        EXPECT_NEAR(pixel.fourth / exact.sums[3], 1, 0.05) << spread;
        EXPECT_NEAR(pixel.largest, 1 + spread * 6 / 7, 1e-6);
        const double variance = exact.sums[1] - exact.sums[0] * exact.sums[0] / (20 * kCount);
        if (spread < 1) EXPECT_GT(std::abs(naive / variance - 1), 1e-4) << "the raw squares do not lose these digits";
    }
}

TEST(FilmParity, BothSidesTakeTheSameSamples) {
    const float below = std::nextafter(shared::kLargestSample, 0.0f);
    const float values[] = {0,
                            1,
                            -3,
                            1e-40f,
                            below,
                            -below,
                            shared::kLargestSample,
                            -1e30f,
                            3e38f,
                            std::numeric_limits<float>::infinity(),
                            std::nanf("")};
    std::vector<glm::vec4> inputs;
    for (const float value : values)
        for (int channel = 0; channel < 3; ++channel) {
            glm::vec4 sample(1, 0, 2, 0);
            sample[channel] = value;
            inputs.push_back(sample);
            inputs.resize(inputs.size() + kRows - 1, glm::vec4(0));
        }
    const auto rows = test::probe("parity/film.comp", 0, inputs, kRows, kRows);
    Parity parity("integrator/film", "fitsFilm", 0);
    for (std::size_t i = 0; i < rows.size(); i += kRows)
        EXPECT_TRUE(parity.near(rows[i + 5].w, reference::fitsFilm<float>(glm::vec3(inputs[i])) ? 1.0f : 0.0f))
            << i / (3 * kRows);
}

}  // namespace
}  // namespace parhelion
