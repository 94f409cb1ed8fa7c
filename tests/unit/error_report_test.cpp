// The parts of an error report: moments, tails, checks, plots.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "analysis/error_monitor.h"
#include "analysis/svg_plot.h"
#include "analysis/tail_slope.h"
#include "support/sampled_film.h"

namespace parhelion {
namespace {

using test::SampledFilm;
using test::SampledScene;
using testing::HasSubstr;
using testing::Not;

TEST(PixelMoments, AreThoseOfTheSamples) {
    // 0 and 1 by turns: variance 1/4 n / (n - 1), no skewness, fourth moment 1/16.
    int i = 0;
    SampledFilm film({.size = {1, 1}, .sample = [&i](double) { return i++ % 3 == 0 ? 1.0 : 0.0; }}, 1);
    const PixelMoments moments = momentsOf(film.growTo(100).pixels[0], 100);
    EXPECT_NEAR(moments.mean, 1.0 / 3, 0.01);
    EXPECT_NEAR(moments.variance, moments.mean * (1 - moments.mean) * 100 / 99, 1e-6);
    EXPECT_NEAR(moments.third, moments.mean * (1 - moments.mean) * (1 - 2 * moments.mean), 1e-6);
    EXPECT_EQ(moments.largest, 1);
}

// 0 +- 0 is not known to be black, and a constant pixel has no noise, whatever its float rounding.
TEST(PixelMoments, OfConstantPixels) {
    for (const double value : {0.0, 0.1, 1e-15, 1e15}) {
        SampledFilm film({.size = {1, 1}, .sample = [value](double) { return value; }}, 1);
        const PixelMoments moments = momentsOf(film.growTo(1000).pixels[0], 1000);
        EXPECT_EQ(moments.isDark(), value == 0);
        EXPECT_EQ(moments.variance, 0);
        EXPECT_NEAR(moments.mean, value, 1e-6 * value);
    }
}

std::vector<double> paretoSamples(double slope, int count) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(1e-12, 1);
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(std::pow(uniform(random), -1 / (slope - 1)));
    return values;
}

TEST(TailSlope, IsThatOfParetosDistribution) {
    for (const double slope : {1.8, 2.5, 4.0}) {
        // 201 values: the exponent less 1 is known to 1 / sqrt(201) = 7 %; five standard deviations.
        EXPECT_NEAR(tailSlope(paretoSamples(slope, 100'000)) - 1, slope - 1, 0.35 * (slope - 1)) << slope;
    }
    EXPECT_EQ(tailSlope(std::vector<double>(10'000, 2.0)), 10);
    EXPECT_EQ(tailSlope({1, 2, 3}), 10);
    EXPECT_EQ(tailSlope({}), 10);
}

FilmError errorOf(const SampledScene& scene, std::uint64_t samples) {
    return estimateFilmError(SampledFilm(scene, 7).growTo(samples)).value();
}

bool isTrusted(const FilmError& error) { return parhelion::isTrusted(judge(error, {})); }

TEST(ErrorChecks, OrdinaryNoisePasses) {
    const SampledScene scene{.sample = [](double u) { return -std::log1p(-u); }};
    const FilmError error = errorOf(scene, 64);
    EXPECT_TRUE(isTrusted(error));
    EXPECT_NEAR(error.rms.value, 1 / 8.0, 0.005);
    EXPECT_EQ(error.pixelsDark, 0);
}

// One sample that outshines all others, infinite variance, sums beyond float: none is converged.
TEST(ErrorChecks, FirefliesAndOverflowFail) {
    int i = 0;
    const SampledScene spike{.sample = [&i](double u) { return ++i == 5000 ? 1e7 : u; }};
    EXPECT_FALSE(isTrusted(errorOf(spike, 64)));
    const SampledScene heavy{.size = {48, 32}, .sample = [](double u) { return std::pow(1 - u, -0.7); }};  // slope 2.4
    EXPECT_FALSE(isTrusted(errorOf(heavy, 256)));
    const SampledScene beyond{.sample = [](double u) { return u < 0.5 ? 9e18 : 1.0; }};
    const FilmError error = errorOf(beyond, 64);
    EXPECT_FALSE(error.isFinite);
    EXPECT_FALSE(isTrusted(error));
    EXPECT_EQ(errorBy(ErrorNorm::Rms, error), std::numeric_limits<double>::infinity());
}

TEST(ErrorChecks, BlackFilmsAreUnknown) {
    EXPECT_FALSE(estimateFilmError(SampledFilm({.sample = [](double) { return 0.0; }}, 1).growTo(64)));
    // Half of the pixels black: 95 % of the pixels are never known.
    int i = 0;
    const FilmError error = errorOf({.sample = [&i](double u) { return i++ % 2 ? u : 0; }}, 64);
    EXPECT_NEAR(error.pixelsDark, 0.5, 0.1);
    EXPECT_EQ(errorBy(ErrorNorm::Pixels, error), std::numeric_limits<double>::infinity());
}

ErrorCheckpoint checkpoint(std::uint64_t samples, double error, double vov) {
    return {.samples = samples,
            .seconds = double(samples),
            .error = error,
            .mean = 1,
            .meanError = error,
            .varianceOfVariance = vov};
}

TEST(ErrorChecks, HistoryIsJudged) {
    const FilmError error = errorOf({.sample = [](double u) { return u; }}, 64);
    std::vector<ErrorCheckpoint> good, bad;
    for (std::uint64_t n = 16; n <= 32; n += 2) {
        good.push_back(checkpoint(n, 0.1 / std::sqrt(double(n)), 1.0 / double(n)));
        // The error stays where it is: new, larger scores keep coming.
        bad.push_back(checkpoint(n, 0.1, 0.05));
    }
    EXPECT_TRUE(parhelion::isTrusted(judge(error, good)));
    EXPECT_FALSE(parhelion::isTrusted(judge(error, bad)));
}

// Predictions follow the fall of the error so far.
TEST(ErrorMonitor, PredictsSamplesAndSeconds) {
    for (const bool stratified : {false, true}) {
        const SampledScene scene{
            .size = {48, 32}, .sample = [](double u) { return 1 + u * u; }, .stratified = stratified};
        SampledFilm film(scene, 3);
        ErrorMonitor monitor(ErrorNorm::Rms);
        for (const std::uint64_t n : {16u, 32u, 64u}) monitor.add(film.growTo(n), double(n) / 10);
        const double target = monitor.checkpoints().back().error / 4;
        const double predicted = monitor.samplesFor(target).value();
        // As 1/sqrt(n); a smooth function of stratified samples as n^-3/2, of which some fall is not counted on.
        EXPECT_NEAR(predicted, stratified ? 64 * std::pow(4, 1 / 1.5) : 64 * 16, stratified ? 50 : 100);
        EXPECT_NEAR(monitor.secondsAt(predicted).value(), predicted / 10, 1);
    }
}

TEST(SvgPlot, DrawsWhatIsPositiveAndEscapesNames) {
    LogPlot plot;
    plot.xName = "a < b & c";
    plot.series.push_back({.name = "one", .points = {{1, 0.1, 0.05, 0.2}, {10, 0.03, 0, 0}, {20, 0, 0, 0}}});
    const std::string svg = toSvg(plot);
    EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; c"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
    EXPECT_EQ(toSvg({}), "");
}

}  // namespace
}  // namespace parhelion
