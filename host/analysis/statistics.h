#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace parhelion {

/// x with P(Z <= x) = probability, Z standard normal; probability in (0, 1).
double normalQuantile(double probability);

/// x with P(T <= x) = probability, T Student with degreesOfFreedom > 0 (need not be an integer; may be infinite).
double studentQuantile(double probability, double degreesOfFreedom);

/// P(X > statistic) for X chi-square distributed with degreesOfFreedom > 0; statistic >= 0, may be infinite.
double chiSquareTail(double statistic, int degreesOfFreedom);

/// |z| above which a two-sided normal test rejects at significance in (0, 1): 4.89 at 1e-6.
double twoSidedThreshold(double significance);

/// The normal deviate that is as improbable as t under Student's distribution: lets tests with differently well known
/// noise share one threshold. Same sign as t, never larger in magnitude. Infinite degrees of freedom: t itself.
double equivalentNormal(double t, double degreesOfFreedom);

/// Significance of each of `tests` tests such that the family of them rejects wrongly with familySignificance.
/// Source: Sidak 1967, "Rectangular Confidence Regions for the Means of Multivariate Normal Distributions".
double sidak(double familySignificance, std::size_t tests);

/// Samples after which a two-sided z-test finds a relative bias with the given power.
/// @param variation  standard deviation of one sample over the mean.
double sampleSizeFor(double relativeBias, double variation, double significance, double power = 0.99);

/// Smallest bias, in units of the standard error, that a test rejecting at |z| > threshold finds with the given power.
double detectableDeviation(double threshold, double power = 0.99);

/// Smallest ripple a that a chi-square test on `samples` samples finds: relative changes +-a of the cell probabilities,
/// which give noncentrality samples * a^2.
double detectableRipple(double samples, int degreesOfFreedom, double significance, double power = 0.99);

/// Running mean and variance without cancellation.
/// Source: Welford 1962, "Note on a Method for Calculating Corrected Sums of Squares and Products".
class RunningMoments {
public:
    void add(double value);
    std::size_t count() const { return count_; }
    double mean() const { return mean_; }
    double variance() const;       ///< of one value, unbiased; 0 for fewer than two
    double standardError() const;  ///< of the mean; 0 for fewer than two

private:
    std::size_t count_ = 0;
    double mean_ = 0;
    double sumOfSquares_ = 0;  ///< of deviations from the mean
};

/// Variance of a sum of independent terms that are each known by an estimate, with its degrees of freedom.
/// Source: Welch 1947, "The Generalization of `Student's' Problem when Several Different Population Variances are
/// Involved" (Satterthwaite's formula).
class PooledVariance {
public:
    /// @param variance  estimated variance of the term, >= 0.
    /// @param degreesOfFreedom  of the estimate, > 0; infinite for a variance known exactly.
    void add(double variance, double degreesOfFreedom);
    void add(const PooledVariance& other);
    double variance() const { return variance_; }
    double deviation() const;
    double degreesOfFreedom() const;  ///< infinite when every term is exact

private:
    double variance_ = 0;
    double uncertainty_ = 0;  ///< sum of variance^2 / degrees of freedom
};

/// A mean and the variance of its estimate.
struct NoisyMean {
    double value = 0;
    PooledVariance noise;
};

/// A deviation in standard errors whose noise is itself an estimate.
struct StudentDeviate {
    double t = 0;
    double degreesOfFreedom = 0;  ///< may be infinite

    double normal() const { return equivalentNormal(t, degreesOfFreedom); }
};

/// a - b in standard errors (Welch). Infinite where a difference has neither noise nor rounding.
/// @param rounding  standard deviation of the rounding of a mean of 1; decides only where noise is absent.
StudentDeviate differenceDeviate(const NoisyMean& a, const NoisyMean& b, double rounding);

/// Slope of the line through points that is nearest to them in y; 0 where all have one x. As many x as y.
double leastSquaresSlope(std::span<const double> x, std::span<const double> y);

/// A ratio and its confidence interval.
struct RatioInterval {
    double ratio = 0;
    double lower = 0;
    double upper = 0;
};

/// a / b for independent a and b, b.value != 0, by the delta method: for noise small against b.
/// @param confidence  in (0, 1), two-sided.
RatioInterval ratioOfMeans(const NoisyMean& a, const NoisyMean& b, double confidence);

/// Estimate against expectation, in standard errors, with the two-sided probability of a deviation at least as large.
struct ZTest {
    double z = 0;
    double pValue = 1;
};

/// @param standardError  >= 0; at 0 only equality passes.
ZTest zTest(double estimate, double expected, double standardError);

/// Pearson's chi-square test.
struct ChiSquare {
    double statistic = 0;  ///< infinite when a cell of expectation zero was hit
    int degreesOfFreedom = 0;
    double pValue = 1;  ///< 0 when a cell of expectation zero was hit
    std::string table;  ///< a line for each cell: observed, expected, contribution
};

/// Compares counts with expected counts. Cells expected below minExpected are pooled into one (and that one with the
/// next smallest until it reaches minExpected); a hit in a cell of expectation zero fails the test outright.
/// Degrees of freedom: cells - 1. The totals are not rescaled: a density that does not integrate to one fails.
/// @throws std::invalid_argument for different lengths, for counts that are negative or not finite, and when fewer than
///         two cells remain after pooling: such a test could not fail.
ChiSquare chiSquareTest(std::span<const double> observed, std::span<const double> expected, double minExpected = 5);

/// Kolmogorov-Smirnov test of samples against a continuous distribution.
struct KolmogorovSmirnov {
    double statistic = 0;  ///< largest distance between the two distribution functions
    double pValue = 1;     ///< asymptotic, with Stephens' correction for finite samples
};

/// @param cdf  the distribution function; called once for each sample.
/// @throws std::invalid_argument for no samples, NaN, or where cdf leaves [0, 1].
KolmogorovSmirnov kolmogorovSmirnovTest(std::vector<double> samples, const std::function<double(double)>& cdf);

}  // namespace parhelion
