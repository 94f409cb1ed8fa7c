#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

#include "analysis/statistics.h"

/// How tests of samplers decide: samples are carried to the unit interval by the exact distribution function, where
/// they must be uniform.
namespace parhelion::test {

/// Every statistical test of a file rejects wrongly with this probability at most, whatever the number of its parts.
inline constexpr double kFamilySignificance = 1e-6;
/// Relative distortion that must be found with probability 0.99: of a mean, or of a density in the root mean square
/// over probability.
inline constexpr double kDistortion = 0.005;

/// A uniform number whose density is bent by `bend`, to 1 - bend (1 - 2 u): a seeded defect, bend / sqrt(3) in the root
/// mean square.
template <typename Real>
Real bent(Real u, double bend) {
    return u + Real(bend) * u * (1 - u);
}
inline std::uint32_t bent(std::uint32_t word, double bend) {
    return std::uint32_t(bent(word * 0x1p-32, bend) * 0x1p32);
}
inline glm::vec2 bent(const glm::vec2& u, const glm::dvec2& bends) { return {bent(u.x, bends.x), bent(u.y, bends.y)}; }
inline glm::uvec4 bent(glm::uvec4 words, const glm::dvec4& bends) {
    for (int i = 0; i < 4; ++i) words[i] = bent(words[i], bends[i]);
    return words;
}

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
    /// Of a draw, bent if asked.
    glm::uvec4 words(const glm::dvec4& bends = glm::dvec4(0)) {
        glm::uvec4 words;
        for (int i = 0; i < 4; ++i) words[i] = word();
        return bent(words, bends);
    }

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
        const double found = detectableRipple(double(samples_), test.degreesOfFreedom, significance_);
        fmt::print("{}: p = {:.3g}, chi-square {:.1f} of {}, {} samples; finds {:.2f} % (power 0.99)\n", what,
                   test.pValue, test.statistic, test.degreesOfFreedom, samples_, 100 * found);
        EXPECT_GT(test.pValue, significance_) << what << '\n' << test.table;
        EXPECT_LT(this->test(rippled(1.2 * kDistortion)).pValue, significance_) << what << ": too few samples";
    }

    /// For seeded defects.
    void expectMisfit(const std::string& what) const {
        const double p = result().pValue;
        fmt::print("seeded defect, {}: p = {:.1e}\n", what, p);
        EXPECT_LT(p, significance_) << what;
    }

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
    const double error = moments.standardError();
    fmt::print("{}: {:.7g} +- {:.2g}, expected {:.7g}, z {:+.2f}\n", what, moments.mean(), error, expected,
               zTest(moments.mean(), expected, error).z);
    EXPECT_TRUE(agrees(moments, expected, significance))
        << what << ": " << moments.mean() << " +- " << error << ", expected " << expected;
}

/// Smallest error of the mean that is found with probability 0.99.
inline double resolution(const RunningMoments& moments, double significance) {
    return detectableDeviation(twoSidedThreshold(significance)) * moments.standardError();
}

/// Also that an error of kDistortion would have been found: of the expectation, or of `least` where that is larger.
inline void expectResolvedMean(const RunningMoments& moments, double expected, double significance,
                               const std::string& what, double least = 0) {
    expectMean(moments, expected, significance, what);
    EXPECT_LE(resolution(moments, significance), kDistortion * std::max(std::abs(expected), least)) << what;
}

/// That samples made from words fit, and that those made from bent ones do not.
/// @param run    counts samples whose four words are bent by what it is given.
/// @param words  those that the samples depend on.
template <typename Run>
void expectFitUnlessBent(const std::string& what, std::initializer_list<int> words, double bend, const Run& run) {
    run(glm::dvec4(0)).expectFit(what);
    for (const int word : words) {
        glm::dvec4 bends(0);
        bends[word] = bend;
        run(bends).expectMisfit(fmt::format("{}, word {} bent by {:g} %", what, word, 100 * bend));
    }
}

/// Which of 36 congruent triangles holds a point of a triangle, by two of its barycentric coordinates: a square grid of
/// their plane, each square cut along its diagonal.
inline std::size_t triangleCell(double b1, double b2) {
    const double x = 6 * std::max(b1, 0.0), y = 6 * std::max(b2, 0.0);
    const int i = std::min(int(x), 5), j = std::min(int(y), 5 - i);
    const bool upper = i + j < 5 && x - i + y - j > 1;
    return std::size_t(i * (12 - i) + 2 * j) + (upper ? 1u : 0u);  // row i holds 2 (5 - i) + 1 cells
}

/// P_1 ... P_4.
inline std::array<double, 4> legendre(double mu) {
    const double mu2 = mu * mu;
    return {mu, (3 * mu2 - 1) / 2, (5 * mu2 - 3) * mu / 2, (35 * mu2 * mu2 - 30 * mu2 + 3) / 8};
}

}  // namespace parhelion::test
