#pragma once

#include <cstdint>
#include <optional>

namespace parhelion::render {

/// Decides which samples a render begins when. Knows of times and counts only, so that it can be tested without a
/// device.
///
/// A window of samples is begun for every pixel, batch after batch, and driven to its end by as many dispatches as it
/// takes. Films do not depend on any of it: sample s of a pixel is the same whenever it is taken, and all pixels end up
/// with equally many, but for a render that runs out of time between two batches.
class SampleSchedule {
public:
    /// What the lanes of the batch under way have, within the window.
    struct Reached {
        std::uint32_t slowest = 0, fastest = 0;
    };

    SampleSchedule(std::size_t batches, double pixels, std::uint64_t sampleCount);

    /// Begins a window when none is under way. False when there is nothing more to do.
    /// @param secondsLeft  for rendering; absent: as long as it takes. At least one sample a pixel is always taken.
    bool begin(std::optional<double> secondsLeft);
    /// Takes note of a dispatch. Returns whether the batch's window is complete; next() goes on then.
    bool advance(Reached reached, double milliseconds, double pathsDone, std::optional<double> secondsLeft);
    /// To the next batch, or to the end of the window. Where there is no time for the batch the render ends between the
    /// two: endsWithin().
    void next(std::optional<double> secondsLeft);
    /// After a moment at which all pixels had the same samples was kept: chooses the next one.
    void pauseAgain(Reached reached);
    /// Begins no samples but those that pixels need to have equally many.
    void finish();
    /// Changes how many samples a pixel gets, but not below what is begun. Returns what it is now.
    std::uint64_t setSampleCount(std::uint64_t count);
    /// Keeps such moments this many milliseconds apart, at least; each costs every lane half a dispatch.
    void setPauseInterval(double milliseconds) { pauseMs_ = milliseconds; }

    std::uint64_t sampleCount() const { return sampleCount_; }
    std::uint64_t windowStart() const { return windowStart_; }  ///< samples that earlier windows finished
    std::uint32_t windowSize() const { return windowSize_; }    ///< 0: to be begun
    std::size_t batch() const { return batch_; }
    std::uint32_t limit() const { return limit_; }  ///< samples of the window that lanes may begin
    bool restarts() const { return restart_; }      ///< lanes begin the window afresh
    /// The batches before batch() have the window's samples, the others have not, and nothing more is to be done.
    bool endsWithin() const { return endsWithin_; }
    std::uint32_t pauseAt() const { return pauseAt_; }  ///< samples of the window that are to be kept; 0: none
    double pathsDone() const { return pathsDone_; }
    double milliseconds() const { return milliseconds_; }
    /// Time for a sample of every pixel; 150 ms before one is done.
    double passMs() const;

private:
    void raiseLimit(Reached reached, std::optional<double> secondsLeft);
    double passesIn(std::optional<double> seconds) const;
    double samplesIn(std::optional<double> seconds, std::uint32_t slowest) const;

    std::size_t batches_;
    double pixels_;
    std::uint64_t sampleCount_;
    std::uint64_t windowStart_ = 0;
    std::uint32_t windowSize_ = 0;
    std::size_t batch_ = 0;
    std::uint32_t limit_ = 0;
    std::uint32_t pauseAt_ = 0;
    bool restart_ = true, endsWithin_ = false;
    Reached reached_;
    double pauseMs_ = 4000;
    double pathsDone_ = 0, milliseconds_ = 0;
    double windowMs_ = 0;  // milliseconds_ when the window began
};

}  // namespace parhelion::render
