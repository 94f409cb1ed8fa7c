#include "analysis/stopping_rule.h"

#include <algorithm>
#include <cmath>

namespace parhelion {
namespace {

constexpr std::uint64_t kPilot = 4;
constexpr double kMostGrowth = 4;      // the further a prediction reaches, the less is it worth
constexpr double kLeastGrowth = 1.02;  // each look at the error makes the device wait for its slowest lane

// What a few samples of a few pixels say is not enough: they may have missed what is rare, most of all where they have
// seen nothing vary at all.
constexpr std::uint64_t kLeast = 16, kLeastOfConstant = 64;
constexpr double kMostVov = 0.1;
// An error that stays unknown is given up: of a black image, or of pixels that nothing hits or that stay uneven.
constexpr std::uint64_t kMostBlack = 1024, kMostUnknown = 65536;

}  // namespace

std::uint64_t StoppingRule::pilot() const { return std::min(kPilot, maximum_); }

bool StoppingRule::isReached(const ErrorMonitor& monitor) const {
    if (monitor.checkpoints().empty()) return false;
    const ErrorCheckpoint& last = monitor.checkpoints().back();
    const std::uint64_t least = std::min(maximum_, last.error > 0 ? kLeast : kLeastOfConstant);
    return last.error <= error_ && last.controlVov < kMostVov && last.samples >= least;
}

std::uint64_t StoppingRule::next(const ErrorMonitor& monitor) const {
    if (monitor.checkpoints().empty()) return pilot();
    const std::uint64_t now = monitor.checkpoints().back().samples;
    if (isReached(monitor)) return now;
    const ErrorCheckpoint& last = monitor.checkpoints().back();
    if (!std::isfinite(last.error) && now >= (last.mean > 0 ? kMostUnknown : kMostBlack)) return now;
    const double wanted = monitor.samplesFor(error_).value_or(2.0 * static_cast<double>(now));
    const double samples = static_cast<double>(now);
    const double next = std::clamp(std::ceil(wanted), std::ceil(kLeastGrowth * samples) + 1, kMostGrowth * samples);
    return std::max(now, static_cast<std::uint64_t>(std::min(next, static_cast<double>(maximum_))));
}

RuleEnd follow(const StoppingRule& rule, ErrorMonitor& monitor, const std::function<Film(std::uint64_t)>& renderTo,
               const std::function<double()>& seconds) {
    for (std::uint64_t next = rule.pilot();;) {
        const Film film = renderTo(next);
        if (film.pixelSamples.empty()) monitor.add(film, seconds());
        if (film.samples < next || !film.pixelSamples.empty()) return RuleEnd::Stopped;
        if (rule.isReached(monitor)) return RuleEnd::Reached;
        next = rule.next(monitor);
        if (next <= film.samples) return RuleEnd::Maximum;
    }
}

}  // namespace parhelion
