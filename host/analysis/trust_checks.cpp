#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "analysis/error_monitor.h"
#include "analysis/statistics.h"

namespace parhelion {
namespace {

using Verdict = TrustCheck::Verdict;

constexpr std::size_t kLeastCheckpoints = 4;
constexpr double kLeastRange = 1.5;  // of samples, below which an exponent is noise

TrustCheck check(std::string name, double found, const char* format, std::string wanted, bool passed) {
    return {std::move(name), fmt::format(fmt::runtime(format), found), std::move(wanted),
            passed ? Verdict::Passed : Verdict::Failed};
}

/// Pearson's t of a correlation: below 0.43 there is none to speak of, above 1.09 there is (Geant4).
double pearsonT(std::span<const double> x, std::span<const double> y) {
    const double n = double(x.size());
    double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) mx += x[i] / n, my += y[i] / n;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mx) * (x[i] - mx);
        yy += (y[i] - my) * (y[i] - my);
        xy += (x[i] - mx) * (y[i] - my);
    }
    if (!(xx > 0) || !(yy > 0)) return 0;
    const double r = std::clamp(xy / std::sqrt(xx * yy), -1.0, 1.0);
    return r * std::sqrt((n - 2) / std::max(1e-12, 1 - r * r));
}

/// Of a power of the samples that the values follow.
double exponent(std::span<const ErrorCheckpoint> points, double ErrorCheckpoint::*value) {
    std::vector<double> samples, values;
    for (const ErrorCheckpoint& p : points) {
        samples.push_back(std::log(double(p.samples)));
        values.push_back(std::log(p.*value));
    }
    return leastSquaresSlope(samples, values);
}

bool falls(std::span<const ErrorCheckpoint> points, double ErrorCheckpoint::*value) {
    // A rise of a few per cent is within the noise of the estimates themselves, and stratified points are at their best
    // at powers of two.
    constexpr double kRise = 1.1;
    for (std::size_t i = 1; i < points.size(); ++i)
        if (points[i].*value > kRise * points[i - 1].*value) return false;
    return true;
}

constexpr const char* kNames[] = {"mean moves at random",
                                  "error falls",
                                  "error falls as 1/sqrt(N)",
                                  "VOV falls",
                                  "VOV falls as 1/N",
                                  "figure of merit does not fall",
                                  "figure of merit has no trend"};
constexpr const char* kWanted[] = {"|t| < 1.09, or within 2 of its errors",
                                   "monotonically",
                                   "exponent -0.5 or steeper, within its noise and 0.1",
                                   "monotonically",
                                   "exponent -1, within its noise and 0.5",
                                   "by less than 10 %",
                                   "|t| < 1.09, or by less than 10 %"};

void judgeHistory(std::span<const ErrorCheckpoint> points, std::vector<TrustCheck>& checks) {
    if (points.size() < kLeastCheckpoints || points.back().samples < kLeastRange * points.front().samples) {
        for (std::size_t i = 0; i < std::size(kNames); ++i)
            checks.push_back({kNames[i],
                              points.empty() ? "no checkpoints"
                                             : fmt::format("{} checkpoints, {} to {} samples", points.size(),
                                                           points.front().samples, points.back().samples),
                              kWanted[i], Verdict::NotJudged});
        return;
    }
    std::vector<double> order, means, merits;
    for (const ErrorCheckpoint& p : points) {
        order.push_back(double(order.size()));
        means.push_back(p.mean);
        merits.push_back(1 / (p.meanError * p.meanError * p.seconds));
    }
    const double drift = std::abs(means.back() - means.front()) / means.back();
    const double meanT = std::abs(pearsonT(order, means)), meritT = std::abs(pearsonT(order, merits));
    const double ofError = exponent(points, &ErrorCheckpoint::meanError);
    const double ofVov = exponent(points, &ErrorCheckpoint::varianceOfVariance);
    // The error is known to half the relative deviation of the variance: three of those, between the ends of the range.
    const double slack = 1.5 * std::sqrt(points.front().varianceOfVariance) /
                         std::log(double(points.back().samples) / double(points.front().samples));
    // A mean that drifts by less than its own error may look ordered by chance: consecutive means share their samples.
    checks.push_back(
        check(kNames[0], meanT, "t = {:.2f}", kWanted[0], meanT < 1.09 || drift < 2 * points.back().meanError));
    checks.push_back(check(kNames[1], points.back().meanError / points.front().meanError, "{:.3f} of its start",
                           kWanted[1], falls(points, &ErrorCheckpoint::meanError)));
    checks.push_back(check(kNames[2], ofError, "exponent {:.2f}", kWanted[2], ofError < -0.4 + slack));
    checks.push_back(check(kNames[3], points.back().varianceOfVariance / points.front().varianceOfVariance,
                           "{:.3f} of its start", kWanted[3], falls(points, &ErrorCheckpoint::varianceOfVariance)));
    checks.push_back(check(kNames[4], ofVov, "exponent {:.2f}", kWanted[4], std::abs(ofVov + 1) < 0.5 + slack));
    // Where stratified points make it rise, all the better.
    const double fall = merits.front() / merits.back() - 1;
    checks.push_back(check(kNames[5], -100 * fall, "{:+.1f} %", kWanted[5], fall < 0.1));
    checks.push_back(check(kNames[6], meritT, "t = {:.2f}", kWanted[6], meritT < 1.09 || fall < 0.1));
}

}  // namespace

std::vector<TrustCheck> judge(const FilmError& error, const std::vector<ErrorCheckpoint>& checkpoints) {
    std::vector<TrustCheck> checks;
    const double relative = error.meanRelative() / 1.96;
    checks.push_back(check("sums are within float", error.isFinite ? 1 : 0, "{}", "1", error.isFinite));
    checks.push_back(check("relative error R of the mean", relative, "{:.2g}", "< 0.1", relative < 0.1));
    checks.push_back(check("variance of the variance (VOV)", error.varianceOfVariance, "{:.2g}", "< 0.1",
                           error.varianceOfVariance < 0.1));
    checks.push_back(check("largest sample once more", error.largestOnceMore, "moves the mean by {:.2g} half widths",
                           "< 1", error.largestOnceMore < 1));
    checks.push_back(check("slope of the tail", error.tailSlope, "{:.1f}", "> 3", error.tailSlope > 3));
    const auto half = std::ranges::find_if(checkpoints, [&](const ErrorCheckpoint& p) {
        return 2 * p.samples >= checkpoints.back().samples && p.meanError > 0 && p.varianceOfVariance > 0;
    });
    judgeHistory({half, checkpoints.end()}, checks);
    return checks;
}

bool isTrusted(const std::vector<TrustCheck>& checks) {
    return std::ranges::none_of(checks, [](const TrustCheck& c) { return c.verdict == Verdict::Failed; });
}

}  // namespace parhelion
