#include "support/parity_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace parhelion::test {
namespace {

struct Entry {
    double worstUlps = 0;
    std::uint64_t cases = 0;
};

/// Prints the table when the executable's tests are over.
class ParityReport : public testing::Environment {
public:
    void enter(const std::string& module, const std::string& function, const ErrorMeter& meter) {
        Entry& entry = entries_[{module, function}];
        entry.worstUlps = std::max(entry.worstUlps, meter.worst() / 2);
        entry.cases += meter.cases();
    }

    void TearDown() override {
        for (const auto& [name, entry] : entries_)
            fmt::print("parity  {:<26}  {:<40}  {:>9.3g}  {:>9}\n", name.first, name.second, entry.worstUlps,
                       entry.cases);
    }

private:
    std::map<std::pair<std::string, std::string>, Entry> entries_;
};

/// GoogleTest takes environments before main and deletes them after it.
ParityReport& report = *static_cast<ParityReport*>(testing::AddGlobalTestEnvironment(new ParityReport));

}  // namespace

double ErrorMeter::add(double actual, double expected, double scale) {
    ++cases_;
    double error = std::abs(actual - expected) / (kRounding * std::max(scale, kSmallestScale));
    if (actual == expected) error = 0;  // equal infinities
    if (std::isnan(error)) error = std::numeric_limits<double>::infinity();
    worst_ = std::max(worst_, error);
    return error;
}

double ErrorMeter::add(double actual, double expected) { return add(actual, expected, std::abs(expected)); }

Parity::Parity(std::string module, std::string function, double roundings)
    : module_(std::move(module)), function_(std::move(function)), roundings_(roundings) {}

Parity::~Parity() {
    report.enter(module_, function_, meter_);
    // A test that a filter or a shard leaves out makes no record.
    const bool isCut = testing::Test::HasFatalFailure() || testing::Test::IsSkipped();
    if (meter_.cases() == 0 && !isCut) ADD_FAILURE() << module_ << ", " << function_ << ": nothing was compared";
}

testing::AssertionResult Parity::near(double actual, double expected, double scale) {
    const double error = meter_.add(actual, expected, scale);
    if (error <= roundings_) return testing::AssertionSuccess();
    return testing::AssertionFailure() << fmt::format(
               "{}: device {:.9g}, reference {:.9g}: {:.3g} roundings of {:.3g}, "
               "at most {:g} are due",
               function_, actual, expected, error, scale, roundings_);
}

testing::AssertionResult Parity::near(double actual, double expected) {
    return near(actual, expected, std::abs(expected));
}

testing::AssertionResult Parity::near(const glm::dvec3& actual, const glm::dvec3& expected, double scale) {
    for (int i = 0; i < 3; ++i)
        if (const auto result = near(actual[i], expected[i], scale); !result)
            return testing::AssertionFailure() << "component " << i << ", " << result.message();
    return testing::AssertionSuccess();
}

testing::AssertionResult Parity::equal(std::uint64_t actual, std::uint64_t expected) {
    const double error = meter_.add(double(actual), double(expected), 1);
    if (error == 0) return testing::AssertionSuccess();
    return testing::AssertionFailure() << fmt::format("{}: device {:#x}, reference {:#x}", function_, actual, expected);
}

}  // namespace parhelion::test
