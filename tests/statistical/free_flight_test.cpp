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

/// Flights counted in equally likely cells; one more cell holds those that escape.
CellTest flightsInto(const Flight& flight, const OpticalDepth& tau, double tEnd, double share = 1) {
    const std::vector<double> edges = quantiles(tau, tEnd);
    std::vector<double> probabilities(kCells, -std::expm1(-tau(tEnd)) / kCells);
    probabilities.push_back(std::exp(-tau(tEnd)));
    CellTest cells(probabilities, significance());
    const auto count = std::uint32_t(share * double(cells.samplesNeeded()));
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto t = flight(i);
        const auto cell = [&] { return std::upper_bound(edges.begin(), edges.end(), double(*t)) - edges.begin(); };
        cells.add(t ? std::size_t(cell()) : kCells);
    }
    return cells;
}

CellTest flightsThrough(const TrackedMedium& medium, bool stochasticFilter = true, double sigmaFactor = 1,
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

TrackedMedium lumps(glm::vec3 from, glm::vec3 to, float slack = 1) {
    const glm::uvec3 n(20, 9, 17);
    std::vector<float> voxels;
    for (unsigned i = 0; i < n.x * n.y * n.z; ++i) {
        const glm::vec3 p(i % n.x, i / n.x % n.y, i / (n.x * n.y));
        const float wave = std::sin(0.9f * p.x) * std::cos(0.7f * p.y) + std::sin(0.5f * p.z);
        voxels.push_back(std::max(0.0f, wave / 2));
    }
    return TrackedMedium::grid(2, n, voxels, {4, 3, 3}, from, to, slack);
}

TEST(FreeFlight, FollowsLumpsOnSkewRays) {
    flightsThrough(lumps({0, 0.2f, 0.1f}, {4, 2.7f, 2.9f})).expectFit("skew");
    flightsThrough(lumps({3.9f, 2.9f, 1.5f}, {0.1f, 0.3f, 1.4f}), false).expectFit("backwards");
    flightsThrough(lumps({2, 1.5f, 0}, {2, 1.5f, 3}, 4)).expectFit("bounds four times too high");  // H20
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
    const TrackedMedium medium = lumps({0, 0.2f, 0.1f}, {4, 2.7f, 2.9f});
    Tracker tracker(medium);
    std::vector<double> distances;
    // D = 0.005 is found with probability 0.99 from (3.9 / 0.005)^2 samples on: 2.7 of the limit and 1.2 of scatter.
    for (std::uint32_t i = 0; distances.size() < 620'000; ++i)
        if (const auto t = tracker.fly(i)) distances.push_back(double(*t));
    const double scattered = -std::expm1(-medium.exact->total());
    const auto cdf = [&](double factor) {
        return [&, factor](double t) { return -std::expm1(-factor * medium.exact->at(t)) / scattered; };
    };
    EXPECT_GT(kolmogorovSmirnovTest(distances, cdf(1)).pValue, significance());
    EXPECT_LT(kolmogorovSmirnovTest(distances, cdf(0.98)).pValue, significance()) << "seeded defect";
}

}  // namespace
}  // namespace parhelion::reference
