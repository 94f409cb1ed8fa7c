#include "analysis/film_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/film_observations.h"
#include "analysis/statistics.h"
#include "analysis/tail_slope.h"
#include "analysis/variance_factors.h"

namespace parhelion {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kArithmetic = 0x1p-20;  // that float may do to a mean, relative
constexpr double kCovered = 0.975;       // of a two-sided 95 %

/// Sums over observations, from which all follows.
struct Sums {
    double weight = 0;
    std::array<double, 4> mean{}, variance{};  ///< by channel; variances as of independent samples
    double varianceSquares = 0;                ///< of the luminance's variances: sum of their own variances
    double squares = 0;                        ///< of the luminance's variances
    double spreadSquares = 0;                  ///< the same, as the observations differ from each other
    double largestDeviation = 0;
    bool isFinite = true;
};

void add(Sums& sums, const Observation& o, const PixelMoments& moments) {
    sums.weight += o.weight;
    for (int c = 0; c < 3; ++c) {
        const auto channel = static_cast<std::size_t>(c);
        sums.mean[channel] += o.weight * meanOf(*o.pixel, c, o.samples);
        sums.variance[channel] += o.weight * varianceOfMean(*o.pixel, c, o.samples);
    }
    const double variance = o.weight * moments.variance / moments.samples;
    sums.mean[3] += o.weight * moments.mean;
    sums.variance[3] += variance;
    if (variance > 0) sums.varianceSquares += variance * variance * 2 / moments.degreesOfFreedom();
    sums.squares += variance * variance / o.weight;
    sums.spreadSquares += variance * variance;
    sums.isFinite =
        sums.isFinite && moments.isFinite && std::isfinite(sums.variance[0] + sums.variance[1] + sums.variance[2]);
    const double deviation = (moments.largest - moments.mean) / moments.samples;
    if (deviation > sums.largestDeviation) sums.largestDeviation = deviation;
}

double medianMean(std::span<const Observation> observations) {
    std::vector<double> means;
    means.reserve(3 * observations.size());
    for (const Observation& o : observations)
        for (int c = 0; c < 3; ++c) means.push_back(std::abs(meanOf(*o.pixel, c, o.samples)));
    const auto middle = means.begin() + static_cast<std::ptrdiff_t>(means.size() / 2);
    std::nth_element(means.begin(), middle, means.end());
    return *middle;
}

/// sqrt(value) with an interval, for a variance known to a relative variance of `uncertainty`.
Interval rootOf(double variance, double uncertainty) {
    const double reach = std::exp(normalQuantile(kCovered) * 0.5 * std::sqrt(uncertainty));
    const double root = std::sqrt(variance);
    return {root, root / reach, root * reach};
}

/// Weighted quantile of values that are sorted.
double quantile(const std::vector<std::pair<double, double>>& sorted, double total, double share) {
    double sum = 0;
    for (const auto& [value, weight] : sorted)
        if ((sum += weight) >= share * total) return value;
    return sorted.empty() ? 0 : sorted.back().first;
}

void judgePixels(const Observations& observations, FilmError& error) {
    const std::vector<bool> holds = trustedPixels(
        observations.all.size(), [&](std::size_t i) { return observations.judged(i); }, observations.grid,
        observations.radius);
    std::vector<std::pair<double, double>> trusted, all;
    double total = 0, trustedWeight = 0;
    for (std::size_t i = 0; i < holds.size(); ++i) {
        const Observation& o = observations.all[i];
        const PixelMoments moments = momentsOf(*o.pixel, o.samples);
        const double relative = moments.mean > 0 ? intervalOf(moments, o.factor).halfWidth / moments.mean : kInfinity;
        total += o.weight;
        all.emplace_back(holds[i] ? relative : kInfinity, o.weight);
        if (moments.isDark()) error.pixelsDark += o.weight;
        if (!holds[i]) continue;
        trusted.emplace_back(relative, o.weight);
        trustedWeight += o.weight;
        if (relative <= 0.01) error.pixelsWithin += o.weight;
    }
    std::ranges::sort(trusted);
    std::ranges::sort(all);
    constexpr double kShares[] = {0.5, 0.95, 0.99};
    for (std::size_t i = 0; i < 3; ++i) error.pixels[i] = quantile(trusted, trustedWeight, kShares[i]);
    error.worstPixels = quantile(all, total, 0.95);
    error.pixelsTrusted = trustedWeight / total;
    error.pixelsWithin /= total;
    error.pixelsDark /= total;
    error.pixelsSpiky = std::max(0.0, 1 - error.pixelsTrusted - error.pixelsDark);
}

double relativeMseOf(std::span<const Observation> observations) {
    const double median = medianMean(observations), epsilon = 0.01 * median * 0.01 * median;
    double sum = 0, weight = 0;
    for (const Observation& o : observations) {
        weight += o.weight;
        for (int c = 0; c < 3; ++c) {
            const double variance = o.factor * varianceOfMean(*o.pixel, c, o.samples),
                         mean = meanOf(*o.pixel, c, o.samples);
            if (variance > 0) sum += o.weight * variance / (mean * mean + epsilon);
        }
    }
    return sum / (3 * weight);
}

/// Of the brightest sample of each pixel: the largest of all are among them.
double tailSlopeOf(std::span<const Observation> observations) {
    std::vector<double> deviations;
    for (const Observation& o : observations) {
        const PixelMoments moments = momentsOf(*o.pixel, o.samples);
        if (moments.variance > 0) deviations.push_back(moments.largest - moments.mean);
    }
    return tailSlope(std::move(deviations));
}

/// The image's mean and the root mean square error alone.
/// @param census  the observations are the image; otherwise a sample of it, of which each pixel has kControlRuns.
std::optional<FilmError> meanErrorOf(std::span<const Observation> observations, const VarianceFactors& factors,
                                     double pixels, double unit, bool census) {
    Sums sums;
    std::uint64_t least = ~0ull;
    for (const Observation& o : observations) {
        if (o.samples < 2) return std::nullopt;
        least = std::min(least, o.samples);
        add(sums, o, momentsOf(*o.pixel, o.samples));
    }
    FilmError error;
    error.samples = least;
    error.isFinite = sums.isFinite;
    if (!(sums.mean[3] > 0) || !sums.isFinite) return sums.isFinite ? std::nullopt : std::optional(error);
    const double total = sums.variance[3] * sums.variance[3];
    const double own = total > 0 ? sums.varianceSquares / total : 0;
    const double drawn = census || total == 0 ? 0 : shared::kControlRuns * sums.spreadSquares / total;
    const double uncertainty = own + factors.uncertainty() + drawn;
    error.varianceOfVariance = own;
    const double freedom = uncertainty > 0 ? std::max(1.0, 2 / uncertainty) : kInfinity;
    const double reach = studentQuantile(kCovered, freedom);
    double variance = 0, mean = 0;
    for (std::size_t c = 0; c < 4; ++c) {
        const double ofChannel = factors.ofImage(int(c)) * sums.variance[c] / sums.weight,
                     m = sums.mean[c] / sums.weight;
        const double half = reach * std::sqrt(ofChannel / pixels) + kArithmetic * m;
        error.mean[c] = {m * unit, (m - half) * unit, (m + half) * unit};
        if (c < 3) variance += ofChannel / 3, mean += m / 3;
        if (c == 3 && half > 0) error.largestOnceMore = sums.largestDeviation / pixels / half;
    }
    // The sum of squared errors of this image: normal ones, whose squares have a variance of twice their own squared.
    const double realised = total > 0 ? 2 * sums.squares / total : 0;
    error.rms = rootOf(variance / (mean * mean), uncertainty + realised);
    return error;
}

/// All of it. As uncertain as the root mean square error is that relative to each pixel.
std::optional<FilmError> errorOf(const Observations& observed, const VarianceFactors& factors, double pixels,
                                 double unit, bool census) {
    std::optional<FilmError> error = meanErrorOf(observed.all, factors, pixels, unit, census);
    if (!error || !error->isFinite) return error;
    const double square = relativeMseOf(observed.all);
    const double reach = error->rms.value > 0 ? std::pow(error->rms.upper / error->rms.value, 2) : 1;
    error->relativeMse = {square, square / reach, square * reach};
    error->tailSlope = tailSlopeOf(observed.all);
    judgePixels(observed, *error);
    return error;
}

/// studentQuantile(kCovered, degreesOfFreedom) for every pixel of an image: to 1e-4 of itself.
/// Source: Hill 1970, "Student's t-Quantiles"; Abramowitz and Stegun 26.7.5.
double studentReach(double degreesOfFreedom) {
    constexpr double kExpandedFrom = 8;
    static const std::array<double, 8> few = [] {
        std::array<double, 8> quantiles{};
        for (std::size_t i = 1; i < 8; ++i) quantiles[i] = studentQuantile(kCovered, static_cast<double>(i));
        return quantiles;
    }();
    if (degreesOfFreedom < kExpandedFrom)
        return few[std::max<std::size_t>(1, static_cast<std::size_t>(degreesOfFreedom))];
    static const double z = normalQuantile(kCovered);
    const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z, v = degreesOfFreedom;
    return z + (z3 + z) / (4 * v) + (5 * z5 + 16 * z3 + 3 * z) / (96 * v * v) +
           (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * v * v * v);
}

}  // namespace

PixelInterval intervalOf(const PixelMoments& moments, double factor) {
    PixelInterval interval{.center = moments.mean};
    if (!moments.isFinite) return interval;
    const double n = moments.samples;
    interval.halfWidth = studentReach(moments.degreesOfFreedom()) * std::sqrt(factor * moments.variance / n) +
                         kArithmetic * std::abs(moments.mean);
    if (moments.variance > 0) interval.center += factor * moments.third / (6 * moments.variance * n);
    return interval;
}

double FilmError::meanRelative() const {
    return mean[3].value > 0 ? (mean[3].upper - mean[3].lower) / 2 / mean[3].value : kInfinity;
}

std::optional<FilmError> estimateFilmError(const Film& film) {
    const VarianceFactors factors(film, true);
    const auto observations = observeImage(film, factors);
    return errorOf(observations, factors, static_cast<double>(film.pixels.size()), film.radianceUnit, true);
}

std::optional<FilmError> estimateMeanError(const Film& film) {
    const VarianceFactors factors(film, true);
    return meanErrorOf(observeImage(film, factors).all, factors, static_cast<double>(film.pixels.size()),
                       film.radianceUnit, true);
}

std::optional<FilmError> estimateControlError(const Film& film) {
    if (film.controls.empty()) return std::nullopt;
    const VarianceFactors factors(film, false);
    const auto observations = observeControls(film, factors);
    return errorOf(observations, factors, static_cast<double>(film.pixels.size()), film.radianceUnit, false);
}

PixelErrors estimatePixelErrors(const Film& film) {
    const VarianceFactors factors(film, true);
    const Observations observations = observeImage(film, factors);
    const std::vector<bool> holds = trustedPixels(
        observations.all.size(), [&](std::size_t i) { return observations.judged(i); }, observations.grid,
        observations.radius);
    PixelErrors errors;
    for (std::size_t i = 0; i < holds.size(); ++i) {
        const JudgedPixel pixel = observations.judged(i);
        errors.halfWidth.push_back(
            static_cast<float>(intervalOf(pixel.moments, pixel.factor).halfWidth * film.radianceUnit));
        errors.isTrusted.push_back(holds[i] ? 1 : 0);
    }
    return errors;
}

std::vector<float> varianceFactorsOf(const Film& film) {
    std::vector<float> all;
    if (!film.stratified || film.controls.empty()) return all;
    const VarianceFactors factors(film, true);
    for (std::size_t i = 0; i < film.pixels.size(); ++i)
        all.push_back(static_cast<float>(factors.near({i % film.crop.size.x, i / film.crop.size.x})));
    return all;
}

}  // namespace parhelion
