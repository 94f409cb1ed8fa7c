#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "app/text_format.h"

namespace parhelion::app {

namespace {

constexpr double kRedrawSeconds = 0.2;
constexpr int kBarWidth = 20;

}  // namespace

double RenderProgress::fraction() const {
    if (secondsLeft) return seconds > 0 ? seconds / (seconds + std::max(0.0, *secondsLeft)) : 0;
    return target || !(samplesTotal > 0) ? 0 : samplesDone / samplesTotal;
}

std::string describeProgress(const RenderProgress& progress) {
    std::string text = fmt::format("{:3.0f} %", 100 * progress.fraction());
    if (progress.samplesDone > 0 && progress.seconds > 0)
        text += fmt::format(", {} samples/s", formatCount(progress.samplesDone / progress.seconds));
    if (progress.secondsLeft) text += fmt::format(", {} left", formatDuration(std::max(0.0, *progress.secondsLeft)));
    if (progress.error) text += fmt::format(", error {}", formatPercent(*progress.error));
    if (progress.error && progress.target) text += fmt::format(" (to be {})", formatPercent(*progress.target));
    return text;
}

ProgressDisplay::ProgressDisplay(std::FILE* stream, bool quiet)
    : stream_(stream),
      quiet_(quiet),
      terminal_(isatty(fileno(stream)) == 1),
      start_(std::chrono::steady_clock::now()) {}

void ProgressDisplay::begin(const std::string& title, double pixels, std::uint64_t samples,
                            std::optional<double> targetError,
                            std::optional<std::chrono::steady_clock::time_point> deadline) {
    if (!quiet_) fmt::print(stream_, "{}\n", title);
    state_ = {};
    state_.target = targetError;
    pixels_ = pixels;
    mostSamples_ = pixels * static_cast<double>(samples);
    deadline_ = deadline;
    start_ = std::chrono::steady_clock::now();
}

void ProgressDisplay::note(const std::string& text) {
    if (quiet_) return;
    end();
    fmt::print(stream_, "{}\n", text);
}

double ProgressDisplay::secondsSinceBegin() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void ProgressDisplay::update(double samplesDone, double samplesTotal, const ErrorMonitor& monitor) {
    if (quiet_) return;
    state_.samplesDone = samplesDone;
    state_.samplesTotal = samplesTotal;
    state_.seconds = secondsSinceBegin();
    state_.error = monitor.errorAt(samplesDone / pixels_);
    state_.secondsLeft = secondsLeft(monitor);
    if (terminal_ && state_.seconds >= nextRedraw_) {
        redraw();
        lineShown_ = true;
        nextRedraw_ = state_.seconds + kRedrawSeconds;
    }
    const int tenths = static_cast<int>(10 * state_.fraction());
    if (!terminal_ && tenths > tenthsShown_) {
        fmt::print(stream_, "{}\n", describeProgress(state_));
        tenthsShown_ = tenths;
    }
}

/// Until the first of what may end the render; nothing while that is unknown.
std::optional<double> ProgressDisplay::secondsLeft(const ErrorMonitor& monitor) const {
    std::optional<double> left;
    const auto ends = [&left](double seconds) { left = std::min(left.value_or(seconds), seconds); };
    if (deadline_) ends(std::chrono::duration<double>(*deadline_ - std::chrono::steady_clock::now()).count());
    const auto samples = state_.target ? monitor.samplesFor(*state_.target) : std::nullopt;
    if (!(state_.samplesDone > 0)) return left;
    const double rate = state_.samplesDone / state_.seconds;
    if (samples) ends((*samples * pixels_ - state_.samplesDone) / rate);
    if (!state_.target || (samples && mostSamples_ < *samples * pixels_))
        ends((mostSamples_ - state_.samplesDone) / rate);
    return left;
}

void ProgressDisplay::end() {
    if (lineShown_) fmt::print(stream_, "\r\x1b[K");
    lineShown_ = false;
}

void ProgressDisplay::redraw() const {
    const int filled = static_cast<int>(std::clamp(state_.fraction(), 0.0, 1.0) * kBarWidth);
    fmt::print(stream_, "\r[{:#>{}}{:.>{}}] {}\x1b[K", "", filled, "", kBarWidth - filled, describeProgress(state_));
    std::fflush(stream_);
}

}  // namespace parhelion::app
