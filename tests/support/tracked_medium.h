#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "compile/majorant_grid.h"
#include "reference/volume/tracking.h"
#include "support/exact_optical_depth.h"
#include "support/hand_scene.h"

namespace parhelion::test {

inline constexpr glm::uvec3 kLumpyResolution{20, 9, 17};

/// Voxels in [0, 1], x fastest, with empty stretches and different in every direction.
inline std::vector<float> lumpyVoxels() {
    constexpr glm::uvec3 n = kLumpyResolution;
    std::vector<float> voxels;
    for (unsigned i = 0; i < n.x * n.y * n.z; ++i) {
        const glm::vec3 p(i % n.x, i / n.x % n.y, i / (n.x * n.y));
        const float wave = std::sin(0.9f * p.x) * std::cos(0.7f * p.y) + std::sin(0.5f * p.z);
        voxels.push_back(std::max(0.0f, wave / 2));
    }
    return voxels;
}

/// One medium and one ray through it, for tests of the tracking alone.
struct TrackedMedium {
    HandScene scene;
    reference::Ray<float> ray;
    float tEnd = 1;
    std::optional<ExactOpticalDepth> exact;  ///< of grids

    /// A homogeneous medium along a ray of length `length`.
    static TrackedMedium homogeneous(float sigma, float length, glm::vec3 sigmaRatio = glm::vec3(1)) {
        TrackedMedium tracked;
        tracked.scene.addHomogeneous(sigma, glm::vec3(1), 0, sigmaRatio);
        tracked.ray.origin = glm::vec3(0);
        tracked.ray.direction = {0, 0, 1};
        tracked.tEnd = length;
        return tracked;
    }

    /// A grid that spans [0, extent], with the majorants that compileScene builds, each times `slack`, and the ray from
    /// `from` to `to`.
    static TrackedMedium grid(float sigma, glm::uvec3 resolution, std::span<const float> voxels, glm::vec3 extent,
                              glm::vec3 from, glm::vec3 to, float slack = 1) {
        TrackedMedium tracked;
        tracked.scene.addGrid(sigma, glm::vec3(1), resolution, voxels, glm::vec3(0), extent);
        const std::vector<float> values(voxels.begin(), voxels.end());
        tracked.scene.scene.majorants = buildMajorants(DensityGrid::fromDense(resolution, values)).bounds;
        for (float& bound : tracked.scene.scene.majorants) bound *= slack;
        tracked.ray.origin = from;
        tracked.ray.direction = glm::normalize(to - from);
        tracked.tEnd = glm::length(to - from);
        const glm::dvec3 scale = glm::dvec3(resolution) / glm::dvec3(extent);
        tracked.exact.emplace(values, resolution, scale * glm::dvec3(from), scale * glm::dvec3(tracked.ray.direction),
                              sigma, tracked.tEnd);
        return tracked;
    }

    /// lumpyVoxels over [0, 4] x [0, 3] x [0, 3].
    static TrackedMedium lumps(float sigma, glm::vec3 from, glm::vec3 to, float slack = 1) {
        return grid(sigma, kLumpyResolution, lumpyVoxels(), {4, 3, 3}, from, to, slack);
    }
    /// Along a skew ray, which meets an optical depth of 1.187 sigma.
    static TrackedMedium lumps(float sigma, float slack = 1) {
        return lumps(sigma, {0, 0.2f, 0.1f}, {4, 2.7f, 2.9f}, slack);
    }
};

/// What the tracking functions are called with, for one path after another.
class Tracker {
public:
    explicit Tracker(const TrackedMedium& tracked, bool stochasticFilter = true)
        : tracked_(tracked), view_(tracked.scene.scene) {
        quality_.stochasticFilter = stochasticFilter;
    }

    /// Distance of the first real collision, or nothing; of path number i.
    std::optional<float> fly(std::uint32_t i, reference::Throughput<float>& throughput) {
        const auto path = context(i);
        reference::Residual<float> residual = firstResidual(path.stream.key, shared::kDrawCamera);
        return reference::trackFlight(path, medium(), tracked_.ray, tracked_.tEnd, 0, residual, throughput);
    }
    std::optional<float> fly(std::uint32_t i) {
        reference::Throughput<float> throughput;
        return fly(i, throughput);
    }

    /// Estimate of the transmittance per channel by path number i.
    glm::vec3 transmit(std::uint32_t i, float threshold) {
        const auto path = context(i);
        reference::Residual<float> residual = firstResidual(path.stream.key, shared::kDrawLight);
        glm::vec3 weight(1);
        const bool isAlive =
            reference::trackShadow(path, medium(), tracked_.ray, tracked_.tEnd, 1, threshold, residual, weight);
        return isAlive ? weight : glm::vec3(0);
    }

    reference::Medium<float>& medium() { return view_.media[0]; }
    const reference::Counters& counters() const { return counters_; }

private:
    reference::PathContext<float, reference::NoTrace> context(std::uint32_t i) {
        return {view_, quality_, reference::streamOf(i, 0, 0, 0), int(i % 3), counters_, trace_};
    }

    static reference::Residual<float> firstResidual(glm::uvec2 key, std::uint32_t purpose) {
        const glm::uvec4 words = reference::draw(key, 0, purpose);
        return {reference::exponential<float>(words.z, words.w >> 8)};
    }

    const TrackedMedium& tracked_;
    reference::SceneView<float> view_;
    Quality quality_;
    reference::Counters counters_{};
    reference::NoTrace trace_;
};

}  // namespace parhelion::test
