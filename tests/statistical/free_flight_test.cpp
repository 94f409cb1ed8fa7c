#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "reference/integrator/path_tracer.h"
#include "support/goodness.h"
#include "support/tracked_medium.h"

// The distance to the first collision and the share that escapes, against exp(-tau) with tau in closed form.
namespace parhelion::reference {
namespace {

using test::CellTest;
using test::TrackedMedium;
using test::Tracker;

constexpr std::size_t kCells = 16;

// Eleven fits and their means, one of 33 bins, Kolmogorov-Smirnov, and the step's four: 28.
double significance() { return sidak(test::kFamilySignificance, 30); }

using OpticalDepth = std::function<double(double t)>;
using Flight = std::function<std::optional<float>(std::uint32_t i)>;

/// Distances between which a flight ends with equal probability, by bisection.
std::vector<double> quantiles(const OpticalDepth& tau, double tEnd) {
    const double scattered = -std::expm1(-tau(tEnd));
    std::vector<double> edges;
    for (std::size_t k = 1; k < kCells; ++k) {
        double low = 0, high = tEnd;
        for (int i = 0; i < 60; ++i) {
            const double middle = (low + high) / 2;
            const bool isBelow = -std::expm1(-tau(middle)) * kCells < scattered * double(k);
            (isBelow ? low : high) = middle;
        }
        edges.push_back(low);
    }
    return edges;
}

/// Flights counted in equally likely cells, of which one more holds those that escape, and their optical depths.
struct Flights {
    CellTest cells;
    RunningMoments depths;  ///< each up to the end of the segment
    double tauEnd;

    /// Also the mean depth of an exponential that ends at tauEnd. Its variation is at most 1, which takes fewer samples
    /// than the cells do.
    void expectFit(const std::string& what) const {
        cells.expectFit(what);
        test::expectResolvedMean(depths, -std::expm1(-tauEnd), significance(), what + ", mean optical depth");
    }
    void expectMisfit(const std::string& what) const { cells.expectMisfit(what); }
};

Flights flightsInto(const Flight& flight, const OpticalDepth& tau, double tEnd, double share = 1) {
    const std::vector<double> edges = quantiles(tau, tEnd);
    std::vector<double> probabilities(kCells, -std::expm1(-tau(tEnd)) / kCells);
    probabilities.push_back(std::exp(-tau(tEnd)));
    Flights flights{CellTest(probabilities, significance()), {}, tau(tEnd)};
    const auto count = std::uint32_t(share * double(flights.cells.samplesNeeded()));
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto t = flight(i);
        const auto cell = [&] { return std::upper_bound(edges.begin(), edges.end(), double(*t)) - edges.begin(); };
        flights.cells.add(t ? std::size_t(cell()) : kCells);
        flights.depths.add(t ? tau(double(*t)) : flights.tauEnd);
    }
    return flights;
}

/// @param share  of the samples that a distortion of half a percent needs; seeded defects are larger.
Flights flightsThrough(const TrackedMedium& medium, bool stochasticFilter = true, double sigmaFactor = 1,
                       double share = 1) {
    Tracker tracker(medium, stochasticFilter);
    tracker.medium().sigmaMax *= float(sigmaFactor);
    return flightsInto([&](std::uint32_t i) { return tracker.fly(i); }, [&](double t) { return medium.exact->at(t); },
                       double(medium.tEnd), share);
}

TEST(FreeFlight, IsExponentialInAHomogeneousMedium) {
    for (const float depth : {0.01f, 1.0f, 5.0f}) {
        const TrackedMedium medium = TrackedMedium::homogeneous(depth / 2, 2);
        Tracker tracker(medium);
        const double sigma = double(depth) / 2;
        flightsInto([&](std::uint32_t i) { return tracker.fly(i); }, [&](double t) { return sigma * t; }, 2)
            .expectFit("tau " + std::to_string(depth));
    }
    const TrackedMedium medium = TrackedMedium::homogeneous(0.98f, 1);
    Tracker tracker(medium);
    flightsInto([&](std::uint32_t i) { return tracker.fly(i); }, [](double t) { return t; }, 1)
        .expectMisfit("sigma off by 2 %");
}

TEST(FreeFlight, FollowsTwoVoxelsInterpolated) {
    // Density from 1/3 to 1 between the centres: tau is 0.5 as for the step, but P(first half) is 0.1446547.
    const std::vector<float> voxels{1 / 3.0f, 1};
    const TrackedMedium medium =
        TrackedMedium::grid(0.75f, {1, 1, 2}, voxels, {1, 1, 1}, {0.3f, 0.4f, 0}, {0.3f, 0.4f, 1});
    EXPECT_NEAR(medium.exact->total(), 0.5, 1e-7);
    EXPECT_NEAR(-std::expm1(-medium.exact->at(0.5)), 0.1446547, 1e-7);
    for (const bool stochastic : {true, false}) flightsThrough(medium, stochastic).expectFit("two voxels");
    flightsThrough(medium, true, 0.98, 0.5).expectMisfit("sigma off by 2 %");
}

TEST(FreeFlight, FollowsLinearDensity) {
    // 0.2 + 1.3 t from t = 0 to 1, between the first and the last of 17 voxel centres: several majorant cells.
    std::vector<float> voxels;
    for (int i = 0; i <= 16; ++i) voxels.push_back((0.2f + 1.3f * float(i) / 16) / 1.5f);
    const TrackedMedium medium = TrackedMedium::grid(1.5f, {17, 1, 1}, voxels, {17 / 16.0f, 1, 1},
                                                     {1 / 32.0f, 0.5f, 0.5f}, {33 / 32.0f, 0.5f, 0.5f});
    EXPECT_NEAR(std::exp(-medium.exact->total()), 0.427414932, 2e-7);
    EXPECT_NEAR(medium.exact->at(0.736602839), 0.5, 2e-7);
    flightsThrough(medium).expectFit("linear");
    flightsThrough(medium, true, 0.98, 0.5).expectMisfit("sigma off by 2 %");
    // Two voxels for 17: the ray then starts and ends half a voxel of the others' length inside.
    const TrackedMedium coarse = TrackedMedium::grid(1.5f, {2, 1, 1}, std::vector{voxels.front(), voxels.back()},
                                                     {1, 1, 1}, {0, 0.5f, 0.5f}, {1, 0.5f, 0.5f});
    Tracker tracker(coarse);
    flightsInto([&](std::uint32_t i) { return tracker.fly(i); }, [&](double t) { return medium.exact->at(t); }, 1, 0.5)
        .expectMisfit("linear between the borders for between the centres");
}

TEST(FreeFlight, FollowsLumpsOnSkewRays) {
    const TrackedMedium skew = TrackedMedium::lumps(2);
    flightsThrough(skew).expectFit("skew");
    flightsThrough(TrackedMedium::lumps(2, {3.9f, 2.9f, 1.5f}, {0.1f, 0.3f, 1.4f}), false).expectFit("backwards");
    flightsThrough(TrackedMedium::lumps(2, {2, 1.5f, 0}, {2, 1.5f, 3}, 4))
        .expectFit("bounds four times too high");  // H20
    for (const bool stochastic : {true, false})
        flightsThrough(skew, stochastic, 0.98, 0.5).expectMisfit("sigma off by 2 %");
}

TEST(FreeFlight, BoundsTooLowWouldBeSeen) {  // H17: in a constant density the flight then sees the bound
    const std::vector<float> voxels(8, 1.0f);
    const auto constant = [&](float slack) {
        return TrackedMedium::grid(1, {2, 2, 2}, voxels, {1, 1, 1}, {0.1f, 0.2f, 0}, {0.3f, 0.7f, 1}, slack);
    };
    flightsThrough(constant(1)).expectFit("constant");
    flightsThrough(constant(0.9f), true, 1, 0.5).expectMisfit("bounds a tenth too low");
}

// Densities 1/3 and 1 of sigma 0.75 in boxes that touch: grids of one voxel, so that one bound, 0.75, serves both.
test::HandScene twoTouchingMedia() {
    test::HandScene scene;
    const std::vector<float> thin{1 / 3.0f}, thick{1};
    const std::uint32_t first = scene.addGrid(0.75f, glm::vec3(1), {1, 1, 1}, thin, {-1, -1, 0}, {1, 1, 0.5f}, 3);
    const std::uint32_t second = scene.addGrid(0.75f, glm::vec3(1), {1, 1, 1}, thick, {-1, -1, 0.5f}, {1, 1, 1});
    scene.addBox({-1, -1, 0}, {1, 1, 0.5f}, scene.addNull(first));
    scene.addBox({-1, -1, 0.5f}, {1, 1, 1}, scene.addNull(second));
    return scene;
}

/// Flies from the origin along z through media that touch.
class StepFlight {
public:
    explicit StepFlight(const test::HandScene& scene) : view_(scene.scene) {}

    /// Distance of path number i's first event, or nothing.
    std::optional<float> operator()(std::uint32_t i) {
        const PathContext<float, NoTrace> path{view_, quality_, streamOf(i, 0, 0, 0), 0, counters, trace_};
        const glm::uvec4 words = draw(path.stream.key, 0, shared::kDrawCamera);
        PathState<float> state;
        state.ray.origin = glm::vec3(0);
        state.ray.direction = {0, 0, 1};
        state.ray.inside = 0;
        state.residual = {exponential<float>(words.z, words.w >> 8)};
        const FlightEnd<float> end = fly(path, state);
        if (end.kind == FlightEnd<float>::Kind::Escape) return std::nullopt;
        return end.t;
    }

    Counters counters{};

private:
    SceneView<float> view_;
    Quality quality_;
    NoTrace trace_;
};

double stepDepth(double t) { return t < 0.5 ? 0.25 * t : 0.125 + 0.75 * (t - 0.5); }

TEST(FreeFlight, FollowsAStepBetweenTwoMedia) {  // H38
    const test::HandScene scene = twoTouchingMedia();
    StepFlight step(scene);
    RunningMoments distance;
    std::uint64_t firstHalf = 0, flights = 0;
    const auto flight = [&](std::uint32_t i) {
        const std::optional<float> t = step(i);
        ++flights;
        firstHalf += t && *t < 0.5f;
        if (t) distance.add(*t);
        return t;
    };
    flightsInto(flight, stepDepth, 1).expectFit("step");
    // The numbers of the list of hard cases, derived apart from tau above.
    const double n = double(flights), limit = twoSidedThreshold(significance());
    const auto expectShare = [&](double found, double p) {
        EXPECT_LT(std::abs(found / n - p), limit * std::sqrt(p * (1 - p) / n));
    };
    expectShare(double(firstHalf), 0.1175030974);
    expectShare(double(distance.count() - firstHalf), 0.2759662429);
    test::expectMean(distance, 0.5881950555, significance(), "mean distance");
    // The number of tentative collisions is at most Poisson distributed in variance.
    EXPECT_NEAR(double(step.counters[shared::kCounterCollisions]) / n, 0.6284755, limit * std::sqrt(0.75 / n));
}

/// 32 bins of equal length, and one for what escapes.
CellTest firstEvents(StepFlight step, double share = 1) {
    constexpr std::size_t kBins = 32;
    std::vector<double> probabilities;
    for (std::size_t i = 0; i < kBins; ++i)
        probabilities.push_back(std::exp(-stepDepth(double(i) / kBins)) - std::exp(-stepDepth(double(i + 1) / kBins)));
    probabilities.push_back(std::exp(-0.5));
    CellTest cells(probabilities, significance());
    const auto count = std::uint32_t(share * double(cells.samplesNeeded()));
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::optional<float> t = step(i);
        cells.add(t ? test::partOf(double(*t), kBins) : kBins);
    }
    return cells;
}

// The baseline's test of this name: density 0.25, then 0.75 over a unit segment, there with p = 0.445.
TEST(BaselineFirstEvent, ChiSquareIn33BinsOfDistance) {
    test::HandScene scene = twoTouchingMedia();
    firstEvents(StepFlight(scene)).expectFit("first event");
    scene.medium(0).sigmaMax *= 1.02f;
    firstEvents(StepFlight(scene), 0.5).expectMisfit("first density off by 2 %");
}

TEST(FreeFlight, KolmogorovSmirnovAgrees) {
    const TrackedMedium medium = TrackedMedium::lumps(2);
    const auto distances = [&](float sigmaFactor) {
        Tracker tracker(medium);
        tracker.medium().sigmaMax *= sigmaFactor;
        std::vector<double> found;
        // sqrt(n) D is beyond 2.99 by chance with the significance of one of 30 tests, and D scatters by 0.5 / sqrt(n)
        // at most: D = 0.005 is found with probability 0.99 from ((2.99 + 2.33 / 2) / 0.005)^2 = 691 000 samples on.
        for (std::uint32_t i = 0; found.size() < 700'000; ++i)
            if (const auto t = tracker.fly(i)) found.push_back(double(*t));
        return found;
    };
    const double scattered = -std::expm1(-medium.exact->total());
    const auto cdf = [&](double t) { return -std::expm1(-medium.exact->at(t)) / scattered; };
    EXPECT_GT(kolmogorovSmirnovTest(distances(1), cdf).pValue, significance());
    EXPECT_LT(kolmogorovSmirnovTest(distances(0.98f), cdf).pValue, significance()) << "sigma off by 2 %";
}

}  // namespace
}  // namespace parhelion::reference
