#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

namespace parhelion::test {

/// A float rounding moves a value of size `scale` by at most kRounding * scale.
inline constexpr double kRounding = 0x1p-24;
/// Scale below which a float loses digits (and the device flushes to zero): a rounding of it is the smallest normal.
inline constexpr double kSmallestScale = 0x1p-102;

/// Worst error of a formula over its inputs, in roundings.
class ErrorMeter {
public:
    /// @param scale  size of the numbers that were rounded; the error counts in units of kRounding * scale.
    /// @return this error; infinite where only one of the two is finite.
    double add(double actual, double expected, double scale);
    double add(double actual, double expected);  ///< relative: of scale |expected|

    double worst() const { return worst_; }
    std::uint64_t cases() const { return cases_; }

private:
    double worst_ = 0;
    std::uint64_t cases_ = 0;
};

/// Compares one shader function with the reference and enters the worst error into the parity report, which the
/// test executable prints at its end: `parity  module  function  worst-ulps  cases` (an ulp is two roundings). A record
/// to which nothing was compared fails its test.
class Parity {
public:
    /// @param module     path of the shader without suffix, e.g. "core/math".
    /// @param function   its function, or several separated by spaces that only make sense together.
    /// @param roundings  how many may add up; 0: the results are equal.
    Parity(std::string module, std::string function, double roundings);
    ~Parity();
    Parity(const Parity&) = delete;
    Parity& operator=(const Parity&) = delete;

    testing::AssertionResult near(double actual, double expected, double scale);
    testing::AssertionResult near(double actual, double expected);  ///< relative: of scale |expected|
    testing::AssertionResult near(const glm::dvec3& actual, const glm::dvec3& expected, double scale = 1);
    /// For decisions and integers.
    testing::AssertionResult equal(std::uint64_t actual, std::uint64_t expected);

    double worst() const { return meter_.worst(); }

private:
    std::string module_, function_;
    double roundings_;
    ErrorMeter meter_;
};

}  // namespace parhelion::test
