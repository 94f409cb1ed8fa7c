#include "render/sample_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace parhelion::render {
namespace {

/// A device of which every dispatch takes 150 ms, in which a lane does as many samples as fit, the slowest half as many
/// as the fastest.
class FakeDevice {
public:
    FakeDevice(std::size_t batches, std::size_t lanes, double samplesPerDispatch)
        : lanes_(lanes), rate_(samplesPerDispatch), done_(batches, std::vector<double>(lanes, 0)) {}

    std::optional<double> deadline;
    double now = 0;

    std::optional<double> left() const { return deadline ? std::optional(*deadline - now) : std::nullopt; }

    /// Renders until the schedule has nothing more to do. `between` is called after each dispatch.
    template <typename Between>
    void render(SampleSchedule& schedule, const Between& between) {
        while (schedule.begin(left())) {
            std::vector<double>& lanes = done_[schedule.batch()];
            if (schedule.restarts()) std::ranges::fill(lanes, 0.0);
            const double before = total();
            for (std::size_t i = 0; i < lanes.size(); ++i) {
                const double speed = rate_ * (1 + double(i) / double(lanes_));
                lanes[i] = std::max(lanes[i], std::min<double>(lanes[i] + speed, schedule.limit()));
            }
            now += 0.15;
            finished_ += total() - before;
            const auto [slowest, fastest] = std::ranges::minmax(lanes);
            const SampleSchedule::Reached reached{std::uint32_t(slowest), std::uint32_t(fastest)};
            if (schedule.advance(reached, 150, std::floor(finished_), left())) {
                for (const double samples : lanes) EXPECT_EQ(std::floor(samples), schedule.windowSize());
                schedule.next(left());
            }
            if (schedule.endsWithin()) break;
            between(schedule);
        }
    }
    void render(SampleSchedule& schedule) {
        render(schedule, [](SampleSchedule&) {});
    }

private:
    double total() const {
        double sum = 0;
        for (const auto& lanes : done_) sum += std::accumulate(lanes.begin(), lanes.end(), 0.0);
        return sum;
    }

    std::size_t lanes_;
    double rate_, finished_ = 0;
    std::vector<std::vector<double>> done_;
};

TEST(SampleSchedule, TakesTheSamplesAskedFor) {
    for (const std::size_t batches : {std::size_t{1}, std::size_t{3}})
        for (const std::uint64_t samples : {1u, 7u, 500u}) {
            SampleSchedule schedule(batches, double(batches) * 64, samples);
            FakeDevice(batches, 64, 3).render(schedule);
            EXPECT_EQ(schedule.windowStart(), samples);
            EXPECT_EQ(schedule.windowSize(), 0u);
        }
}

// A deadline is kept to a dispatch or two, with pixels that all have equally many samples.
TEST(SampleSchedule, KeepsADeadline) {
    for (const double rate : {0.05, 0.7, 20.0, 400.0})
        for (const double deadline : {10.0, 60.0}) {
            SampleSchedule schedule(1, 64, 1u << 24);
            FakeDevice device(1, 64, rate);
            device.deadline = deadline;
            device.render(schedule);
            EXPECT_EQ(schedule.windowSize(), 0u);
            EXPECT_GT(schedule.windowStart(), 0u);
            EXPECT_LE(device.now, deadline + 0.6) << rate;
            const double pass = 0.15 / (1.5 * rate);
            EXPECT_GE(device.now, 0.9 * deadline - 2 * pass) << rate << " samples a dispatch";
        }
}

TEST(SampleSchedule, TakesOneSampleHoweverShortTheTime) {
    for (const std::size_t batches : {std::size_t{1}, std::size_t{3}}) {
        SampleSchedule schedule(batches, double(batches) * 64, 1000);
        FakeDevice device(batches, 64, 0.01);
        device.deadline = 1;
        device.render(schedule);
        EXPECT_EQ(schedule.windowStart(), 1u);
    }
}

// The first dispatch, of a device nobody knows, does not take the time of hundreds.
TEST(SampleSchedule, BeginsCarefullyWhereTimeCounts) {
    SampleSchedule schedule(1, 64, 1u << 24);
    FakeDevice device(1, 64, 20);
    device.deadline = 0.01;
    device.render(schedule);
    EXPECT_GT(schedule.windowStart(), 0u);
    EXPECT_LE(device.now, 0.5);
}

// A large film whose last pass does not fit: the batches that do get it.
TEST(SampleSchedule, EndsBetweenBatchesWhereTimeEnds) {
    SampleSchedule schedule(4, 4 * 64, 1000);
    FakeDevice device(4, 64, 0.05);  // a pass takes 12 s
    device.deadline = 44;
    device.render(schedule);
    EXPECT_TRUE(schedule.endsWithin());
    EXPECT_GT(schedule.windowStart(), 0u);
    EXPECT_GT(schedule.batch(), 0u);
    EXPECT_LT(schedule.batch(), 4u);
    EXPECT_NEAR(device.now, 44, 4);
    EXPECT_FALSE(schedule.begin({}));
}

TEST(SampleSchedule, SamplesMayBecomeMoreOrFewer) {
    for (const std::size_t batches : {std::size_t{1}, std::size_t{3}}) {
        SampleSchedule schedule(batches, double(batches) * 64, 16);
        FakeDevice device(batches, 64, 3);
        device.render(schedule);
        EXPECT_EQ(schedule.setSampleCount(100), 100u);
        device.render(schedule);
        EXPECT_EQ(schedule.windowStart(), 100u);
        // Fewer than begun is not possible; what is begun is finished.
        schedule.setSampleCount(1'000'000);
        std::uint64_t kept = 0;
        device.render(schedule, [&](SampleSchedule& s) {
            if (kept == 0) kept = s.setSampleCount(1);
        });
        EXPECT_GT(kept, 100u);
        EXPECT_EQ(schedule.windowStart(), kept);
    }
}

TEST(SampleSchedule, FinishingLeavesAllPixelsAlike) {
    SampleSchedule schedule(1, 64, 1'000'000);
    FakeDevice device(1, 64, 3);
    int dispatches = 0;
    device.render(schedule, [&](SampleSchedule& s) {
        if (++dispatches == 5) s.finish();
    });
    EXPECT_GT(schedule.windowStart(), 0u);
    EXPECT_LT(schedule.windowStart(), 1'000'000u);
    EXPECT_EQ(schedule.windowSize(), 0u);
}

}  // namespace
}  // namespace parhelion::render
