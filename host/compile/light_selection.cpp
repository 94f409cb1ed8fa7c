#include <cmath>
#include <numeric>

#include "compile/compile_lights.h"

namespace parhelion {

void assignSelection(std::span<const double> powers, std::span<shared::Light> lights) {
    double largest = 0.0;
    std::size_t sampled = 0, last = 0;
    for (std::size_t i = 0; i < powers.size(); ++i) {
        largest = std::max(largest, powers[i]);
        if (powers[i] > 0.0) ++sampled, last = i;
    }
    double total = 0.0;  // in units of the largest: powers near the limits of double must not overflow
    for (const double power : powers) total += power > 0.0 ? power / largest : 0.0;

    constexpr double kSteps = 0x1p24;
    double running = 0.0, previous = 0.0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (powers[i] > 0.0) running += 0.5 / double(sampled) + 0.5 * (powers[i] / largest) / total;
        const bool complete = sampled > 0 && i >= last;
        const double cumulative = complete ? 1.0 : std::round(running * kSteps) / kSteps;
        lights[i].cumulative = float(cumulative);
        lights[i].selection = powers[i] > 0.0 ? float(cumulative - previous) : 0.0f;
        previous = cumulative;
    }
}

}  // namespace parhelion
