#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/film_error.h"

namespace parhelion {

/// What "an error of 1 %" means; all are relative.
enum class ErrorNorm {
    Rms,     ///< root mean square error over pixels and channels over the image's mean: what an eye calls noise
    RelMse,  ///< root of the relative mean squared error: dark pixels count as much as bright ones
    Mean,    ///< half width of the 95 % interval of the image's mean
    Pixels,  ///< 95 % of the pixels have a 95 % interval of at most this half width, and one that can be trusted
};

/// The word that chooses a norm: "rms", "relmse", "mean", "pixels".
const char* nameOf(ErrorNorm norm);
double errorBy(ErrorNorm norm, const FilmError& error);

/// The error at a moment of a render.
struct ErrorCheckpoint {
    std::uint64_t samples = 0;  ///< a pixel
    double seconds = 0;         ///< since rendering began
    double error = 0;           ///< by the norm, from the control pixels; infinite where nothing is known
    double mean = 0;            ///< of the image's luminance, radiance
    double meanError = 0;       ///< standard error of that over it
    double varianceOfVariance = 0;
    double controlVov = 1;  ///< variance of the variance that the control pixels go by
};

/// The error of a render as it goes on: what a progress display shows, a stopping rule decides on and a report judges.
class ErrorMonitor {
public:
    explicit ErrorMonitor(ErrorNorm norm) : norm_(norm) {}

    /// Takes note of a film in which all pixels have equally many samples, more than at the last time.
    void add(const Film& film, double seconds);
    ErrorNorm norm() const { return norm_; }
    const std::vector<ErrorCheckpoint>& checkpoints() const { return checkpoints_; }
    /// The error with `samples` samples a pixel, by its fall so far; nothing before the first checkpoint that knows
    /// one.
    std::optional<double> errorAt(double samples) const;
    /// Samples a pixel at which the error is `target` (> 0); nothing while unknown.
    std::optional<double> samplesFor(double target) const;
    /// Seconds since rendering began at which `samples` are done.
    std::optional<double> secondsAt(double samples) const;

private:
    double slope() const;

    ErrorNorm norm_;
    std::vector<ErrorCheckpoint> checkpoints_;
};

/// One reason to trust, or not to trust, what a render says of its error.
struct TrustCheck {
    enum class Verdict { Passed, Failed, NotJudged };
    std::string name, found, wanted;
    Verdict verdict = Verdict::NotJudged;
};

/// The ten checks by which Monte Carlo transport codes judge a tally, applied to the image's mean, and three of our
/// own. Those of how things go on look at the checkpoints of the render's second half, and want at least four of them.
/// Sources: MCNP6 User's Manual, "The Ten Statistical Checks"; Geant4, G4ConvergenceTester.
std::vector<TrustCheck> judge(const FilmError& error, const std::vector<ErrorCheckpoint>& checkpoints);
bool isTrusted(const std::vector<TrustCheck>& checks);

}  // namespace parhelion
