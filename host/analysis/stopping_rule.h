#pragma once

#include <functional>

#include "analysis/error_monitor.h"

namespace parhelion {

/// Decides how many samples a render takes to reach an error.
///
/// It knows the error from the control pixels alone, whose samples the image has no part in: whenever it stops, the
/// image is as unbiased as one of so many samples that were asked for, and its intervals hold as well. A rule that
/// looks at the image's own samples stops early where they happen to lack bright ones, and leaves the image too dark.
class StoppingRule {
public:
    /// @param error    to be reached, by the monitor's norm; > 0.
    /// @param maximum  samples a pixel.
    StoppingRule(double error, std::uint64_t maximum) : error_(error), maximum_(maximum) {}

    /// Samples a pixel to begin with.
    std::uint64_t pilot() const;
    /// Samples a pixel to go on to; those of the last checkpoint when the error is reached, the maximum is, or the
    /// error stays unknown: after 1024 samples of a black image, 65536 of others.
    std::uint64_t next(const ErrorMonitor& monitor) const;
    bool isReached(const ErrorMonitor& monitor) const;

private:
    double error_;
    std::uint64_t maximum_;
};

/// How a render that follows a rule ended.
enum class RuleEnd { Reached, Maximum, Stopped };

/// Renders in rounds, looking at the error after each, until the rule is content.
/// @param renderTo  renders until each pixel has as many samples and gives the film, with its control pixels; one with
///                  fewer samples, or with uneven ones, when something else has stopped the render.
/// @param seconds   since rendering began.
RuleEnd follow(const StoppingRule& rule, ErrorMonitor& monitor, const std::function<Film(std::uint64_t)>& renderTo,
               const std::function<double()>& seconds);

}  // namespace parhelion
