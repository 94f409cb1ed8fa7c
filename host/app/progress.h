#pragma once

#include <chrono>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

#include "base/film.h"

namespace parhelion::app {

/// How far a render has come, in samples over all pixels.
struct RenderProgress {
    double samplesDone = 0;
    double samplesTotal = 0;
    double seconds = 0;
    std::optional<double> relativeError;  ///< see estimateRelativeError
};

/// "42 %, 1.23 M samples/s, 12.1 s left, error 3.1 %"
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
    void begin(const std::string& title, double samplesTotal);
    /// Shows the state when it is time to. `film`, when given, is called for now and then for the error estimate,
    /// for at most a hundredth of the time.
    void update(double samplesDone, const std::function<Film()>& film = {});
    /// Clears the redrawn line.
    void end();
    double secondsSinceBegin() const;

private:
    void refreshError(const std::function<Film()>& film);
    void redraw() const;

    std::FILE* stream_;
    bool quiet_;
    bool terminal_;
    std::chrono::steady_clock::time_point start_;
    RenderProgress state_;
    double nextRedraw_ = 0;    ///< seconds since begin()
    double nextEstimate_ = 0;  ///< seconds since begin()
    int tenthsShown_ = 0;
    bool lineShown_ = false;
};

}  // namespace parhelion::app
