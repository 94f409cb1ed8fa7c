#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "app/error_estimate.h"
#include "app/text_format.h"

namespace parhelion::app {

namespace {

constexpr double kRedrawSeconds = 0.2;
constexpr double kFirstEstimateSeconds = 1.0;
/// Seconds between error estimates, per second that one takes.
constexpr double kEstimateInterval = 100.0;
constexpr int kBarWidth = 20;

}  // namespace

std::string describeProgress(const RenderProgress& progress) {
    const double fraction = progress.samplesTotal > 0 ? progress.samplesDone / progress.samplesTotal : 0;
    std::string text = fmt::format("{:3.0f} %", 100 * fraction);
    if (progress.samplesDone > 0 && progress.seconds > 0) {
        const double rate = progress.samplesDone / progress.seconds;
        text += fmt::format(", {} samples/s, {} left", formatCount(rate),
                            formatDuration((progress.samplesTotal - progress.samplesDone) / rate));
    }
    if (progress.relativeError) text += fmt::format(", error {}", formatPercent(*progress.relativeError));
    return text;
}

ProgressDisplay::ProgressDisplay(std::FILE* stream, bool quiet)
    : stream_(stream),
      quiet_(quiet),
      terminal_(isatty(fileno(stream)) == 1),
      start_(std::chrono::steady_clock::now()) {}

void ProgressDisplay::begin(const std::string& title, double samplesTotal) {
    if (!quiet_) fmt::print(stream_, "{}\n", title);
    state_ = {};
    state_.samplesTotal = samplesTotal;
    nextEstimate_ = kFirstEstimateSeconds;
    start_ = std::chrono::steady_clock::now();
}

double ProgressDisplay::secondsSinceBegin() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void ProgressDisplay::update(double samplesDone, const std::function<Film()>& film) {
    if (quiet_) return;
    state_.samplesDone = samplesDone;
    state_.seconds = secondsSinceBegin();
    if (film) refreshError(film);
    if (terminal_ && state_.seconds >= nextRedraw_) {
        redraw();
        lineShown_ = true;
        nextRedraw_ = state_.seconds + kRedrawSeconds;
    }
    const int tenths = static_cast<int>(10 * state_.samplesDone / std::max(1.0, state_.samplesTotal));
    if (!terminal_ && tenths > tenthsShown_) {
        fmt::print(stream_, "{}\n", describeProgress(state_));
        tenthsShown_ = tenths;
    }
}

void ProgressDisplay::end() {
    if (lineShown_) fmt::print(stream_, "\r\x1b[K");
    lineShown_ = false;
}

void ProgressDisplay::refreshError(const std::function<Film()>& film) {
    if (state_.seconds < nextEstimate_) return;
    state_.relativeError = estimateRelativeError(film());
    const double after = secondsSinceBegin();
    nextEstimate_ = after + std::max(kFirstEstimateSeconds, kEstimateInterval * (after - state_.seconds));
}

void ProgressDisplay::redraw() const {
    const double fraction = std::clamp(state_.samplesDone / std::max(1.0, state_.samplesTotal), 0.0, 1.0);
    const int filled = static_cast<int>(fraction * kBarWidth);
    fmt::print(stream_, "\r[{:#>{}}{:.>{}}] {}\x1b[K", "", filled, "", kBarWidth - filled, describeProgress(state_));
    std::fflush(stream_);
}

}  // namespace parhelion::app
