#include <algorithm>
#include <cmath>

#include "compile/compile_lights.h"
#include "compile/distribution_table.h"

namespace parhelion {

void assignSelection(std::span<const double> powers, std::span<shared::Light> lights) {
    double largest = 0.0;
    std::size_t sampled = 0;
    for (const double power : powers) {
        largest = std::max(largest, power);
        sampled += power > 0.0;
    }
    double total = 0.0;  // in units of the largest: powers near the limits of double must not overflow
    for (const double power : powers) total += power > 0.0 ? power / largest : 0.0;

    constexpr double kSteps = 0x1p24;  // the last step rounds to exactly 1: the sum is good to 1e-13
    double running = 0.0, previous = 0.0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (powers[i] > 0.0) running += 0.5 / double(sampled) + 0.5 * (powers[i] / largest) / total;
        const double cumulative = std::round(running * kSteps) / kSteps;
        lights[i].cumulative = float(cumulative);
        lights[i].selection = float(cumulative - previous);
        lights[i].reciprocal = reciprocalOf(std::uint32_t(std::uint64_t((cumulative - previous) * 0x1p32)));
        previous = cumulative;
    }
}

}  // namespace parhelion
