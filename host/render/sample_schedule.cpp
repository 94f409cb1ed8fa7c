#include "render/sample_schedule.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace parhelion::render {
namespace {

constexpr double kFirstPassMs = 150;
constexpr double kRunAheadMs = 2000;  // how far fast pixels may run ahead of slow ones
constexpr std::uint32_t kMinimumRunAhead = 16;
constexpr double kPauseShare = 0.05;  // of the time so far, at least, lies between two moments that are kept
constexpr double kTimeShare = 0.98;   // of the time left that is planned with: lanes end one after the other

}  // namespace

SampleSchedule::SampleSchedule(std::size_t batches, double pixels, std::uint64_t sampleCount)
    : batches_(batches), pixels_(pixels), sampleCount_(sampleCount) {}

double SampleSchedule::passMs() const { return pathsDone_ > 0 ? milliseconds_ * pixels_ / pathsDone_ : kFirstPassMs; }

/// Samples a pixel that there is time for; unlimited before the first is done, whose time nobody knows.
double SampleSchedule::passesIn(std::optional<double> seconds) const {
    if (!seconds || pathsDone_ < pixels_) return std::numeric_limits<double>::infinity();
    return std::max(0.0, kTimeShare * *seconds * 1000 / passMs());
}

/// Samples that there is time for in the slowest lane of the window, at its pace so far.
double SampleSchedule::samplesIn(std::optional<double> seconds, std::uint32_t slowest) const {
    const double passes = passesIn(seconds);
    if (slowest == 0 || std::isinf(passes)) return passes;
    return std::min(passes, passes * passMs() * slowest / (milliseconds_ - windowMs_));
}

bool SampleSchedule::begin(std::optional<double> secondsLeft) {
    if (endsWithin_) return false;
    if (windowSize_ != 0) return true;
    if (windowStart_ >= sampleCount_) return false;
    const std::uint64_t left = sampleCount_ - windowStart_;
    // One batch: everything in one window, so that no lane ever waits. Several: turns long enough to hide the waits.
    double size = static_cast<double>(left);
    if (batches_ > 1) {
        const double passes = passesIn(secondsLeft);
        size = windowStart_ == 0 ? 1 : std::max(std::min(4.0, double(windowStart_)), kRunAheadMs * 2 / passMs());
        // Where there is no time for all batches, the first ones take what there is.
        if (passes < 1.0 / double(batches_)) return false;
        size = std::max(1.0, std::min(size, passes));
    } else if (windowStart_ > 0 && passesIn(secondsLeft) < 1) {
        return false;
    }
    windowSize_ = static_cast<std::uint32_t>(std::min({size, double(left), 0x1p30}));
    batch_ = 0;
    restart_ = true;
    limit_ = 0;
    windowMs_ = milliseconds_;
    pauseAt_ = batches_ > 1 ? windowSize_ : 1;
    if (batches_ == 1 && windowStart_ > 0) pauseAgain({});
    raiseLimit({}, secondsLeft);
    return true;
}

void SampleSchedule::raiseLimit(Reached reached, std::optional<double> secondsLeft) {
    // At first no further than the slowest has come: what is not kept is lost when the render is stopped.
    const double least = std::clamp(double(reached.slowest), 1.0, double(kMinimumRunAhead));
    // Nor before the time of a sample is known, where time is what ends the render.
    const bool isKnown = secondsLeft ? pathsDone_ >= pixels_ : pathsDone_ > 0;
    const double ahead = isKnown ? std::clamp(kRunAheadMs / passMs(), least, 1e9) : least;
    double limit = std::max<double>(limit_, reached.slowest + ahead);
    if (batches_ == 1) {
        // No lane may begin what the slowest has no time for.
        const double last = std::max(1.0, std::floor(reached.slowest + samplesIn(secondsLeft, reached.slowest)));
        limit = std::max<double>(reached.fastest, std::min(limit, last));
        if (limit <= reached.slowest) windowSize_ = reached.slowest;  // the time is over, and all have equally many
    }
    limit_ = static_cast<std::uint32_t>(std::min<double>(windowSize_, limit));
}

bool SampleSchedule::advance(Reached reached, double milliseconds, double pathsDone,
                             std::optional<double> secondsLeft) {
    restart_ = false;
    reached_ = reached;
    milliseconds_ += milliseconds;
    pathsDone_ = pathsDone;
    if (reached.slowest < windowSize_) raiseLimit(reached, secondsLeft);
    return reached.slowest >= windowSize_;
}

void SampleSchedule::next(std::optional<double> secondsLeft) {
    restart_ = true;
    limit_ = 0;
    reached_ = {};
    if (++batch_ < batches_) {
        endsWithin_ = windowStart_ > 0 && passesIn(secondsLeft) < double(windowSize_) / double(batches_);
        raiseLimit({}, {});
        return;
    }
    windowStart_ += windowSize_;
    windowSize_ = 0;
}

void SampleSchedule::pauseAgain(Reached reached) {
    const double apart = std::clamp(std::max(pauseMs_, kPauseShare * milliseconds_) / passMs(), 1.0, 1e9);
    const double at = std::max(reached.fastest + 1.0, reached.slowest + apart);
    pauseAt_ = at < windowSize_ ? static_cast<std::uint32_t>(at) : 0;
}

void SampleSchedule::finish() {
    // Every batch takes as many samples as the first (H81): only there is it still open how many.
    if (windowSize_ != 0 && batch_ == 0) windowSize_ = std::min(windowSize_, limit_);
    sampleCount_ = windowStart_ + windowSize_;
}

std::uint64_t SampleSchedule::setSampleCount(std::uint64_t count) {
    std::uint64_t begun = windowStart_;
    if (windowSize_ != 0) {
        begun += batch_ == 0 ? std::max(limit_, 1u) : windowSize_;
        if (batch_ == 0) {
            const std::uint64_t size = std::max(count, begun) - windowStart_;
            if (batches_ == 1 || size < windowSize_)
                windowSize_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(size, 1u << 30));
        }
    }
    if (pauseAt_ == 0 && batches_ == 1 && windowSize_ != 0) pauseAgain(reached_);
    return sampleCount_ = std::max(count, begun);
}

}  // namespace parhelion::render
