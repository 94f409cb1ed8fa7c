#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>
#include <string>
#include <vector>

#include "analysis/statistics.h"

/// How tests of samplers decide: samples are carried to the unit interval by the exact distribution function, where
/// they must be uniform.
namespace parhelion::test {

/// Every statistical test of a file rejects wrongly with this probability at most, whatever the number of its parts.
inline constexpr double kFamilySignificance = 1e-6;
/// Relative distortion of a density that must be found with probability 0.99.
inline constexpr double kDistortion = 0.005;

/// Uniform numbers from a generator that the renderer does not use, with the renderer's 24 bits.
class IndependentNumbers {
public:
    explicit IndependentNumbers(std::uint64_t seed) : engine_(seed) {}
    template <typename Real>
    Real uniform() {
        return Real(engine_() >> 40) * Real(0x1p-24);
    }
    template <typename Real>
    glm::vec<2, Real> pair() {
        const Real u = uniform<Real>();
        return {u, uniform<Real>()};
    }
    /// All 32 bits.
    std::uint32_t word() { return std::uint32_t(engine_() >> 32); }

private:
    std::mt19937_64 engine_;
};

/// Counts of samples that fall into cells, against the counts expected.
class CellTest {
public:
    /// @param probabilities  of the cells, at least two; they sum to 1.
    /// @param significance   of this one test.
    CellTest(std::vector<double> probabilities, double significance)
        : probabilities_(std::move(probabilities)), significance_(significance), counts_(probabilities_.size(), 0.0) {}

    /// `cells` equally likely cells.
    CellTest(std::size_t cells, double significance)
        : CellTest(std::vector<double>(cells, 1.0 / double(cells)), significance) {}

    /// Samples after which a distortion of kDistortion is found with probability 0.99.
    std::uint64_t samplesNeeded() const {
        const double ripple = detectableRipple(1.0, int(counts_.size()) - 1, significance_) / kDistortion;
        return std::uint64_t(std::ceil(ripple * ripple));
    }

    void add(std::size_t cell) {
        ++counts_.at(cell);
        ++samples_;
    }

    ChiSquare result() const { return test(counts_); }

    /// Also that a distortion of little more than kDistortion would have been found.
    void expectFit(const std::string& what) const {
        const ChiSquare test = result();
        EXPECT_GT(test.pValue, significance_)
            << what << ": chi-square " << test.statistic << " of " << test.degreesOfFreedom << '\n'
            << test.table;
        EXPECT_LT(this->test(rippled(1.2 * kDistortion)).pValue, significance_) << what << ": too few samples";
    }

    /// For seeded defects.
    void expectMisfit(const std::string& what) const { EXPECT_LT(result().pValue, significance_) << what; }

private:
    ChiSquare test(const std::vector<double>& counts) const {
        std::vector<double> expected;
        for (const double p : probabilities_) expected.push_back(p * double(samples_));
        return chiSquareTest(counts, expected);
    }

    /// The defect seeded into every test of a sampler: the counts of one whose density is higher and lower in turn, by
    /// `ripple` of the probability in the root mean square. At kDistortion itself one in a hundred would pass.
    std::vector<double> rippled(double ripple) const {
        double mean = 0;
        for (std::size_t i = 0; i < counts_.size(); ++i) mean += i % 2 == 0 ? probabilities_[i] : -probabilities_[i];
        std::vector<double> counts = counts_;
        for (std::size_t i = 0; i < counts_.size(); ++i) {
            const double change = ((i % 2 == 0 ? 1 : -1) - mean) / std::sqrt(1 - mean * mean);
            counts[i] = std::max(0.0, counts[i] + ripple * probabilities_[i] * change * double(samples_));
        }
        return counts;
    }

    std::vector<double> probabilities_;
    double significance_;
    std::vector<double> counts_;
    std::uint64_t samples_ = 0;
};

/// Which of `cells` equal parts of [0, 1] holds u; rounding beyond the ends counts as inside.
inline std::size_t partOf(double u, std::size_t cells) {
    return std::min(std::size_t(std::max(0.0, u * double(cells))), cells - 1);
}

/// Azimuth as a share of the full turn, in [0, 1).
inline double turnOf(double x, double y) {
    const double turn = std::atan2(y, x) / (2 * std::acos(-1.0));
    return turn < 0 ? turn + 1 : turn;
}

/// Whether a mean agrees with its expectation, at the given significance.
inline bool agrees(const RunningMoments& moments, double expected, double significance) {
    return std::abs(zTest(moments.mean(), expected, moments.standardError()).z) < twoSidedThreshold(significance);
}

inline void expectMean(const RunningMoments& moments, double expected, double significance, const std::string& what) {
    EXPECT_TRUE(agrees(moments, expected, significance))
        << what << ": " << moments.mean() << " +- " << moments.standardError() << ", expected " << expected;
}

}  // namespace parhelion::test
