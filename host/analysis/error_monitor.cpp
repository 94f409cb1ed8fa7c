#include "analysis/error_monitor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/statistics.h"

namespace parhelion {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Error after `ratio` times the samples, relative to that now. What falls faster than 1/sqrt(n) does so the less the
/// more samples there are: the excess is taken to halve with each four times the samples, as between a smooth
/// integrand, for which it stays, and an edge or a volume, where it ends.
double fallOver(double ratio, double slope) {
    return std::exp(-0.5 * std::log(ratio) + 2 * (slope + 0.5) * (1 - 1 / std::sqrt(ratio)));
}

}  // namespace

const char* nameOf(ErrorNorm norm) {
    switch (norm) {
        case ErrorNorm::Rms:
            return "rms";
        case ErrorNorm::RelMse:
            return "relmse";
        case ErrorNorm::Mean:
            return "mean";
        case ErrorNorm::Pixels:
            return "pixels";
    }
    return "";
}

double errorBy(ErrorNorm norm, const FilmError& error) {
    if (!error.isFinite) return kInfinity;
    switch (norm) {
        case ErrorNorm::Rms:
            return error.rms.value;
        case ErrorNorm::RelMse:
            return std::sqrt(error.relativeMse.value);
        case ErrorNorm::Mean:
            return error.meanRelative();
        case ErrorNorm::Pixels:
            return error.worstPixels;
    }
    return kInfinity;
}

void ErrorMonitor::add(const Film& film, double seconds) {
    if (film.samples < 2 || (!checkpoints_.empty() && film.samples <= checkpoints_.back().samples)) return;
    const auto control = estimateControlError(film), own = estimateMeanError(film);
    ErrorCheckpoint point{.samples = film.samples, .seconds = seconds, .error = kInfinity};
    if (control) {
        point.error = errorBy(norm_, *control);
        point.controlVov = control->varianceOfVariance;
    }
    if (own && own->isFinite) {
        point.mean = own->mean[3].value;
        point.meanError = own->meanRelative() / normalQuantile(0.975);
        point.varianceOfVariance = own->varianceOfVariance;
    }
    checkpoints_.push_back(point);
}

/// Of log error over log samples: -1/2 for independent samples, steeper for stratified ones.
double ErrorMonitor::slope() const {
    std::vector<double> samples, errors;  // their logarithms
    const double from = double(checkpoints_.back().samples) / 8;
    for (const ErrorCheckpoint& p : checkpoints_)
        if (double(p.samples) >= from && p.error > 0 && std::isfinite(p.error)) {
            samples.push_back(std::log(double(p.samples)));
            errors.push_back(std::log(p.error));
        }
    if (samples.empty() || samples.back() - samples.front() < std::log(2)) return -0.5;
    return std::clamp(leastSquaresSlope(samples, errors), -1.5, -0.5);
}

std::optional<double> ErrorMonitor::errorAt(double samples) const {
    if (checkpoints_.empty() || !std::isfinite(checkpoints_.back().error)) return std::nullopt;
    const ErrorCheckpoint& last = checkpoints_.back();
    return last.error * fallOver(samples / double(last.samples), slope());
}

std::optional<double> ErrorMonitor::samplesFor(double target) const {
    if (checkpoints_.empty() || !std::isfinite(checkpoints_.back().error)) return std::nullopt;
    const ErrorCheckpoint& last = checkpoints_.back();
    if (!(last.error > 0)) return std::nullopt;  // nothing to extrapolate
    const double wanted = target / std::max(last.error, 1e-300), ofSlope = slope();
    double low = 1e-6, high = 1e12;  // times the samples so far; the fall over them is monotonic
    while (high > low * (1 + 1e-9)) {
        const double middle = std::sqrt(low * high);
        (fallOver(middle, ofSlope) > wanted ? low : high) = middle;
    }
    return high < 1e11 ? std::optional(double(last.samples) * high) : std::nullopt;
}

std::optional<double> ErrorMonitor::secondsAt(double samples) const {
    if (checkpoints_.empty()) return std::nullopt;
    const ErrorCheckpoint& last = checkpoints_.back();
    // By the later part alone: the first samples wait for the device to get ready.
    double samplesBefore = 0, secondsBefore = 0;
    for (const ErrorCheckpoint& p : checkpoints_)
        if (p.samples * 2 <= last.samples) samplesBefore = double(p.samples), secondsBefore = p.seconds;
    const double rate = (last.seconds - secondsBefore) / (double(last.samples) - samplesBefore);
    return last.seconds + rate * (samples - double(last.samples));
}

}  // namespace parhelion
