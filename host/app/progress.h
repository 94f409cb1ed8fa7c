#pragma once

#include <chrono>
#include <cstdio>
#include <optional>
#include <string>

#include "analysis/error_monitor.h"

namespace parhelion::app {

/// How far a render has come, in samples over all pixels.
struct RenderProgress {
    double samplesDone = 0;
    double samplesTotal = 0;
    double seconds = 0;
    std::optional<double> error;        ///< now, by the render's norm
    std::optional<double> target;       ///< of the error
    std::optional<double> secondsLeft;  ///< until the target, the deadline or the samples, whichever is first

    double fraction() const;  ///< done, by time where that is known, else by samples
};

/// "42 %, 1.23 M samples/s, 12.1 s left, error 3.1 % (to be 1 %)"; without the share done where the samples are not
/// what ends the render.
std::string describeProgress(const RenderProgress& progress);

/// Tells a user how a render goes on: one line redrawn on a terminal, a line at every tenth elsewhere.
class ProgressDisplay {
public:
    /// @param stream  where to write; nothing is written when `quiet`.
    ProgressDisplay(std::FILE* stream, bool quiet);
    ~ProgressDisplay() { end(); }
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    /// Says what is rendered and starts the clock.
    /// @param samples  a pixel, at most.
    /// @param targetError, deadline  what may end the render besides its samples.
    void begin(const std::string& title, double pixels, std::uint64_t samples, std::optional<double> targetError = {},
               std::optional<std::chrono::steady_clock::time_point> deadline = {});
    /// Shows the state when it is time to.
    void update(double samplesDone, double samplesTotal, const ErrorMonitor& monitor);
    /// A line of its own.
    void note(const std::string& text);
    /// Clears the redrawn line.
    void end();
    double secondsSinceBegin() const;

private:
    std::optional<double> secondsLeft(const ErrorMonitor& monitor) const;
    void redraw() const;

    std::FILE* stream_;
    bool quiet_;
    bool terminal_;
    std::chrono::steady_clock::time_point start_;
    RenderProgress state_;
    double pixels_ = 1, mostSamples_ = 1;
    std::optional<std::chrono::steady_clock::time_point> deadline_;
    double nextRedraw_ = 0;  ///< seconds since begin()
    int tenthsShown_ = 0;
    bool lineShown_ = false;
};

}  // namespace parhelion::app
