#include "analysis/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

namespace parhelion {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Tables give six digits.
TEST(Quantiles, MatchPublishedTables) {
    EXPECT_NEAR(normalQuantile(0.975), 1.959964, 1e-6);
    EXPECT_NEAR(normalQuantile(0.99), 2.326348, 1e-6);
    EXPECT_NEAR(studentQuantile(0.975, 7), 2.364624, 1e-6);
    EXPECT_NEAR(studentQuantile(0.995, 1), 63.656741, 1e-6);
    EXPECT_EQ(studentQuantile(0.9, kInfinity), normalQuantile(0.9));
    EXPECT_NEAR(twoSidedThreshold(1e-6), 4.891638, 1e-6);
}

TEST(Quantiles, EquivalentNormalKeepsTheTailProbability) {
    // Student with one degree of freedom is Cauchy: P(T > t) = 1/2 - atan(t) / pi.
    for (const double t : {0.1, 1.0, 10.0, 1e4}) {
        const double tail = std::atan(1 / t) / M_PI;
        const double z = equivalentNormal(t, 1);
        EXPECT_NEAR(std::erfc(z / std::sqrt(2.0)) / 2, tail, 1e-12 * tail + 1e-15) << t;
        EXPECT_EQ(equivalentNormal(-t, 1), -z);
    }
    EXPECT_EQ(equivalentNormal(5.0, kInfinity), 5.0);
    EXPECT_EQ(equivalentNormal(0.0, 3), 0.0);
    EXPECT_LE(equivalentNormal(1e300, 1e9), 1e300);
}

TEST(Sidak, SplitsTheFamily) {
    // The chance that none of m tests rejects is (1 - s)^m = 1 - family.
    for (const std::size_t tests : {1u, 100u, 196'608u}) {
        const double single = sidak(1e-6, tests);
        EXPECT_NEAR(-std::expm1(static_cast<double>(tests) * std::log1p(-single)), 1e-6, 1e-18);
    }
    EXPECT_NEAR(twoSidedThreshold(sidak(1e-6, 100)), 5.73, 0.005);
    EXPECT_NEAR(twoSidedThreshold(sidak(1e-6, 256 * 256 * 3)), 6.90, 0.02);
}

TEST(Power, SampleSizesMatchTheClosedForm) {
    // ((4.891638 + 2.326348) / 0.01)^2 = 520993.
    EXPECT_NEAR(sampleSizeFor(0.01, 1.0, 1e-6), 520'993, 2);
    EXPECT_NEAR(sampleSizeFor(0.001, 5.0, 1e-6), 25 * 100 * 520'993.0, 5000);
    EXPECT_NEAR(detectableDeviation(4.891638), 7.217986, 1e-5);
}

TEST(Power, RippleIsFoundAsOftenAsPromised) {
    // Draws 20,000 samples with the ripple that should be found 9 times in 10, 1,000 times over.
    constexpr int kCells = 16, kSamples = 20'000, kTrials = 1'000;
    const double ripple = detectableRipple(kSamples, kCells - 1, 0.01, 0.9);
    std::vector<double> weights, expected(kCells, kSamples / double(kCells));
    for (int i = 0; i < kCells; ++i) weights.push_back(i % 2 == 0 ? 1 + ripple : 1 - ripple);
    std::mt19937 random(17);
    std::discrete_distribution<int> cell(weights.begin(), weights.end());
    int found = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
        std::vector<double> observed(kCells, 0.0);
        for (int i = 0; i < kSamples; ++i) ++observed[cell(random)];
        found += chiSquareTest(observed, expected).pValue < 0.01;
    }
    // Five standard deviations of a binomial count: 5 sqrt(1000 * 0.9 * 0.1) = 47.
    EXPECT_NEAR(found, 900, 47);
}

TEST(Moments, SurviveAnOffsetThatCancelsTheNaiveFormula) {
    RunningMoments moments;
    EXPECT_EQ(moments.variance(), 0.0);
    for (const double x : {1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16}) moments.add(x);
    EXPECT_EQ(moments.mean(), 1e9 + 10);
    EXPECT_EQ(moments.variance(), 30.0);
    EXPECT_DOUBLE_EQ(moments.standardError(), std::sqrt(30.0 / 4));
}

TEST(Moments, PooledVarianceFollowsSatterthwaite) {
    PooledVariance pooled;
    EXPECT_EQ(pooled.degreesOfFreedom(), kInfinity);
    pooled.add(2.0, 4);
    pooled.add(2.0, 4);
    EXPECT_EQ(pooled.variance(), 4.0);
    EXPECT_EQ(pooled.degreesOfFreedom(), 8.0);
    pooled.add(1.0, kInfinity);
    EXPECT_EQ(pooled.degreesOfFreedom(), 12.5);  // 5^2 / (2^2/4 + 2^2/4)
}

TEST(ZTestOf, KnowsItsExtremes) {
    EXPECT_NEAR(zTest(1.2, 1.0, 0.1).z, 2.0, 1e-12);
    EXPECT_NEAR(zTest(1.2, 1.0, 0.1).pValue, 0.0455003, 1e-7);
    EXPECT_EQ(zTest(1.0, 1.0, 0.0).pValue, 1.0);
    EXPECT_EQ(zTest(1.1, 1.0, 0.0).pValue, 0.0);
    EXPECT_EQ(zTest(std::nan(""), 1.0, 1.0).pValue, 0.0);
}

TEST(RatioOfMeans, CoversTheTruthAsOftenAsPromised) {
    std::mt19937 random(23);
    std::normal_distribution<double> noise(0, 0.05);
    int covered = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        NoisyMean mean[2];
        for (int side = 0; side < 2; ++side) {
            RunningMoments moments;
            for (int i = 0; i < 12; ++i) moments.add((side == 0 ? 4.0 : 1.0) + noise(random));
            mean[side].value = moments.mean();
            mean[side].noise.add(moments.variance() / 12, 11);
        }
        const RatioInterval interval = ratioOfMeans(mean[0], mean[1], 0.95);
        covered += interval.lower <= 4 && 4 <= interval.upper;
    }
    // 0.95 * 2000 = 1900, five standard deviations of a binomial count: 49.
    EXPECT_NEAR(covered, 1900, 49);
}

TEST(ChiSquareTest, MatchesClosedForms) {
    // Two degrees of freedom: p = exp(-x / 2).
    const ChiSquare two = chiSquareTest(std::vector<double>{60, 40, 50}, std::vector<double>{50, 50, 50});
    EXPECT_DOUBLE_EQ(two.statistic, 4.0);
    EXPECT_EQ(two.degreesOfFreedom, 2);
    EXPECT_NEAR(two.pValue, std::exp(-2.0), 1e-12);
    // One: p = erfc(sqrt(x / 2)).
    const ChiSquare one = chiSquareTest(std::vector<double>{60, 40}, std::vector<double>{50, 50});
    EXPECT_NEAR(one.pValue, std::erfc(std::sqrt(2.0)), 1e-12);
    EXPECT_NE(one.table.find("chi-square 4, 1 degrees of freedom, p = 0.0455"), std::string::npos) << one.table;
}

TEST(ChiSquareTest, MatchesPublishedCriticalValues) {
    // Upper 1 % points: 52.191 for 31 degrees of freedom, 18.475 for 7 (three decimals: p is good to 1e-5).
    for (const auto& [freedom, critical] : {std::pair{31, 52.191}, std::pair{7, 18.475}}) {
        std::vector<double> expected(freedom + 1, 1000.0), observed = expected;
        const double shift = std::sqrt(critical * 1000 / 2);
        observed[0] += shift;
        observed[1] -= shift;
        EXPECT_NEAR(chiSquareTest(observed, expected).pValue, 0.01, 1e-5) << freedom;
    }
}

TEST(ChiSquareTest, PoolsSmallCells) {
    const std::vector<double> expected{100, 1, 2, 1, 50, 0}, observed{100, 2, 2, 0, 50, 0};
    const ChiSquare result = chiSquareTest(observed, expected, 5);
    // 1 + 2 + 1 is still below 5: the next smallest cell joins. The impossible, empty cell counts for nothing.
    EXPECT_EQ(result.degreesOfFreedom, 1);
    EXPECT_EQ(result.statistic, 0.0);
    EXPECT_NE(result.table.find("pool of 4"), std::string::npos) << result.table;
}

TEST(ChiSquareTest, AnyHitInAnImpossibleCellFails) {
    const ChiSquare result = chiSquareTest(std::vector<double>{1e6, 1e6, 1}, std::vector<double>{1e6, 1e6, 0});
    EXPECT_EQ(result.pValue, 0.0);
    EXPECT_EQ(result.statistic, kInfinity);
}

TEST(ChiSquareTest, DensityThatDoesNotIntegrateToOneFails) {
    const std::vector<double> observed(10, 1e5), expected(10, 0.98e5);
    EXPECT_LT(chiSquareTest(observed, expected).pValue, 1e-6);
}

TEST(ChiSquareTest, RefusesWhatItCannotTest) {
    const std::vector<double> good{10, 10}, three{10, 10, 10}, negative{10, -1}, tiny{1, 1};
    EXPECT_THROW(chiSquareTest(good, three), std::invalid_argument);
    EXPECT_THROW(chiSquareTest(good, negative), std::invalid_argument);
    EXPECT_THROW(chiSquareTest(std::vector<double>{10, kInfinity}, good), std::invalid_argument);
    EXPECT_THROW(chiSquareTest(good, tiny), std::invalid_argument);
}

TEST(ChiSquareTest, PValuesAreUniformUnderTheNull) {
    std::mt19937 random(29);
    std::vector<double> pValues;
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<double> observed(32, 0.0), expected(32, 3200 / 32.0);
        for (int i = 0; i < 3200; ++i) ++observed[random() >> 27];
        pValues.push_back(chiSquareTest(observed, expected).pValue);
    }
    EXPECT_GT(kolmogorovSmirnovTest(pValues, [](double p) { return p; }).pValue, 1e-4);
}

TEST(KolmogorovSmirnovTest, MatchesThePublishedLimit) {
    // D sqrt(n) = 1.3581 is the 5 % point, 2.693 that of 1e-6. Samples at ((i + 1/2) / n) + s are s + 1/2n away.
    for (const auto& [limit, pValue] : {std::pair{1.3581, 0.05}, std::pair{2.693, 1e-6}}) {
        constexpr int kCount = 1'000'000;
        const double shift = limit / std::sqrt(double(kCount));
        std::vector<double> samples;
        for (int i = 0; i < kCount; ++i) samples.push_back((i + 0.5) / kCount);
        const auto cdf = [shift](double x) { return std::min(1.0, x + shift); };
        const KolmogorovSmirnov result = kolmogorovSmirnovTest(samples, cdf);
        EXPECT_NEAR(result.statistic, shift, 1e-6);
        // d(ln p) = -4 x dx; dx = 1e-6 * 1000 from the half step and 0.12 / 1000 * x from Stephens.
        EXPECT_NEAR(result.pValue / pValue, 1.0, 0.02) << limit;
    }
}

TEST(KolmogorovSmirnovTest, TellsDistributionsApart) {
    std::mt19937_64 random(31);
    std::exponential_distribution<double> exponential(1.0);
    std::vector<double> samples(200'000);
    for (double& x : samples) x = exponential(random);
    EXPECT_GT(kolmogorovSmirnovTest(samples, [](double x) { return -std::expm1(-x); }).pValue, 1e-4);
    // 2 % in the rate moves the distribution by 0.02 / e = 0.0074; 2.693 / sqrt(n) = 0.0060 already fails at 1e-6.
    EXPECT_LT(kolmogorovSmirnovTest(samples, [](double x) { return -std::expm1(-1.02 * x); }).pValue, 1e-4);
    samples[5] = std::nan("");
    EXPECT_THROW(kolmogorovSmirnovTest(samples, [](double) { return 0.5; }), std::invalid_argument);
    EXPECT_THROW(kolmogorovSmirnovTest({}, [](double) { return 0.5; }), std::invalid_argument);
    EXPECT_THROW(kolmogorovSmirnovTest({1.0}, [](double) { return 1.5; }), std::invalid_argument);
}

TEST(LeastSquares, FindsTheSlopeOfALine) {
    const std::vector<double> x{1, 2, 4, 8}, line{5, 3, -1, -9}, bent{0, 1, 0, 1};
    EXPECT_NEAR(leastSquaresSlope(x, line), -2, 1e-12);
    // By hand: mean x 3.75, xx = 28.75, xy = 2.5 (y about 0.5).
    EXPECT_NEAR(leastSquaresSlope(x, bent), 2.5 / 28.75, 1e-12);
    EXPECT_EQ(leastSquaresSlope(std::vector<double>{3, 3}, std::vector<double>{1, 2}), 0);
}

}  // namespace
}  // namespace parhelion
