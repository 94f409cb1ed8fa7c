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
    std::vector<glm::vec4> rows(6 * values.size(), glm::vec4(0));
    for (int done = 0; done < count; done += kAtOnce) {
        for (std::size_t i = 0; i < values.size(); ++i) rows[6 * i] = {values[i], std::min(kAtOnce, count - done)};
        rows = test::probe("parity/film.comp", 0, rows, 6, 6);
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
            EXPECT_TRUE(film.near(double(rows[6 * i + 1][c]) + rows[6 * i + 2][c], exact.x)) << i << ", channel " << c;
            EXPECT_TRUE(film.near(double(rows[6 * i + 3][c]) + rows[6 * i + 4][c], exact.y)) << i << ", channel " << c;
            naive.add(rows[6 * i + 5][c], exact.x);
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
    for (int i = 0; i < kCount; ++i) reference::accumulate<float>(pixel, value * float(1 + i % 3), counters);
    Parity parity("integrator/film", "accumulate", 0);
    EXPECT_TRUE(parity.near(rows[1], pixel.sumHigh));
    EXPECT_TRUE(parity.near(rows[2], pixel.sumLow));
    EXPECT_TRUE(parity.near(rows[3], pixel.squareHigh));
    EXPECT_TRUE(parity.near(rows[4], pixel.squareLow));
}

TEST(FilmParity, OneCompensatedSumAgreesToTheBit) {
    std::vector<glm::vec4> inputs;
    test::Stress stress(23);
    for (int i = 0; i < 2'000; ++i) {
        const float size = stress.magnitude(1e-3f, 1e9f);
        inputs.emplace_back(stress.point(stress.magnitude(1e-5f, 1e5f)), 0);
        inputs.emplace_back(stress.point(size), 0);
        inputs.emplace_back(stress.point(size * 0x1p-24f), 0);
        for (int unused = 0; unused < 3; ++unused) inputs.emplace_back(0);
    }
    const auto rows = test::probe("parity/film.comp", 0, inputs, 6, 6);
    Parity parity("integrator/film", "addCompensated", 0);
    for (std::size_t i = 0; i < rows.size(); i += 6)
        for (int c = 0; c < 3; ++c) {
            float high = inputs[i + 1][c], low = inputs[i + 2][c];
            reference::addCompensated<float>(high, low, inputs[i][c]);
            EXPECT_TRUE(parity.near(rows[i][c], high)) << i;
            EXPECT_TRUE(parity.near(rows[i + 1 + std::size_t(c)].w, low)) << i;
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
            inputs.resize(inputs.size() + 5, glm::vec4(0));
        }
    const auto rows = test::probe("parity/film.comp", 0, inputs, 6, 6);
    Parity parity("integrator/film", "fitsFilm", 0);
    for (std::size_t i = 0; i < rows.size(); i += 6)
        EXPECT_TRUE(parity.near(rows[i + 5].w, reference::fitsFilm<float>(glm::vec3(inputs[i])) ? 1.0f : 0.0f))
            << i / 18;
}

}  // namespace
}  // namespace parhelion
