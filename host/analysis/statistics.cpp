#include "analysis/statistics.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace parhelion {

namespace {

namespace math = boost::math;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

double normalQuantile(double probability) { return math::quantile(math::normal(), probability); }

double studentQuantile(double probability, double degreesOfFreedom) {
    if (std::isinf(degreesOfFreedom)) return normalQuantile(probability);
    return math::quantile(math::students_t(degreesOfFreedom), probability);
}

double chiSquareTail(double statistic, int degreesOfFreedom) {
    if (std::isinf(statistic)) return 0;
    return math::cdf(math::complement(math::chi_squared(degreesOfFreedom), statistic));
}

double twoSidedThreshold(double significance) {
    return math::quantile(math::complement(math::normal(), significance / 2));
}

double equivalentNormal(double t, double degreesOfFreedom) {
    if (t == 0 || !std::isfinite(t) || std::isinf(degreesOfFreedom)) return t;
    const double tail = math::cdf(math::complement(math::students_t(degreesOfFreedom), std::abs(t)));
    // Below the smallest double the tail is lost, and no threshold lies that far out.
    const double z = tail > 0 ? math::quantile(math::complement(math::normal(), tail)) : kInfinity;
    return std::copysign(std::min(z, std::abs(t)), t);
}

double leastSquaresSlope(std::span<const double> x, std::span<const double> y) {
    RunningMoments ofX, ofY;
    for (const double value : x) ofX.add(value);
    for (const double value : y) ofY.add(value);
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - ofX.mean()) * (x[i] - ofX.mean());
        xy += (x[i] - ofX.mean()) * (y[i] - ofY.mean());
    }
    return xx > 0 ? xy / xx : 0;
}

double sidak(double familySignificance, std::size_t tests) {
    return -std::expm1(std::log1p(-familySignificance) / static_cast<double>(tests));
}

double sampleSizeFor(double relativeBias, double variation, double significance, double power) {
    return std::pow(detectableDeviation(twoSidedThreshold(significance), power) * variation / relativeBias, 2);
}

double detectableDeviation(double threshold, double power) { return threshold + normalQuantile(power); }

double detectableRipple(double samples, int degreesOfFreedom, double significance, double power) {
    const double critical = math::quantile(math::complement(math::chi_squared(degreesOfFreedom), significance));
    const double noncentrality =
        math::non_central_chi_squared::find_non_centrality(double(degreesOfFreedom), critical, 1 - power);
    return std::sqrt(noncentrality / samples);
}

void RunningMoments::add(double value) {
    ++count_;
    const double before = value - mean_;
    mean_ += before / static_cast<double>(count_);
    sumOfSquares_ += before * (value - mean_);
}

double RunningMoments::variance() const { return count_ < 2 ? 0.0 : sumOfSquares_ / static_cast<double>(count_ - 1); }

double RunningMoments::standardError() const {
    return count_ < 2 ? 0.0 : std::sqrt(variance() / static_cast<double>(count_));
}

void PooledVariance::add(double variance, double degreesOfFreedom) {
    variance_ += variance;
    uncertainty_ += variance * variance / degreesOfFreedom;
}

void PooledVariance::add(const PooledVariance& other) {
    variance_ += other.variance_;
    uncertainty_ += other.uncertainty_;
}

double PooledVariance::deviation() const { return std::sqrt(variance_); }

double PooledVariance::degreesOfFreedom() const {
    // Where the squares underflow, noise is too small for its own uncertainty to matter.
    return uncertainty_ > 0 ? variance_ * variance_ / uncertainty_ : kInfinity;
}

StudentDeviate differenceDeviate(const NoisyMean& a, const NoisyMean& b, double rounding) {
    if (a.value == b.value) return {0, kInfinity};
    PooledVariance noise = a.noise;
    noise.add(b.noise);
    noise.add(std::pow(rounding * std::max(std::abs(a.value), std::abs(b.value)), 2), kInfinity);
    return {(a.value - b.value) / noise.deviation(), noise.degreesOfFreedom()};
}

RatioInterval ratioOfMeans(const NoisyMean& a, const NoisyMean& b, double confidence) {
    const double ratio = a.value / b.value;
    const double ofA = 1 / (b.value * b.value), ofB = ratio * ratio * ofA;
    PooledVariance noise;
    noise.add(ofA * a.noise.variance(), a.noise.degreesOfFreedom());
    noise.add(ofB * b.noise.variance(), b.noise.degreesOfFreedom());
    const double reach = studentQuantile((1 + confidence) / 2, noise.degreesOfFreedom()) * noise.deviation();
    return {ratio, ratio - reach, ratio + reach};
}

ZTest zTest(double estimate, double expected, double standardError) {
    const double difference = estimate - expected;
    if (difference == 0) return {};
    if (!std::isfinite(difference) || !(standardError > 0)) return {std::copysign(kInfinity, difference), 0};
    const double z = difference / standardError;
    return {z, std::erfc(std::abs(z) / std::sqrt(2.0))};
}

}  // namespace parhelion
