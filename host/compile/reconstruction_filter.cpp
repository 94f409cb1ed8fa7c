#include <algorithm>
#include <cmath>

#include "compile/compile_film.h"

namespace parhelion {

namespace {

double filterWeight(const FilmDescription& film, double x, double radius) {
    if (film.filter == ReconstructionFilter::Box) return 1.0;
    if (film.filter == ReconstructionFilter::Tent) return std::max(0.0, 1.0 - x / radius);
    const double scale = -0.5 / (film.filterStddev * film.filterStddev);
    return std::max(0.0, std::exp(scale * x * x) - std::exp(scale * radius * radius));
}

/// Solves integral_0^x (w0 + (w1 - w0) x / step) dx = mass, in the form that does not cancel for w1 < w0.
double invertLinear(double w0, double w1, double step, double mass) {
    const double slope = (w1 - w0) / step;
    return 2.0 * mass / (w0 + std::sqrt(std::max(0.0, w0 * w0 + 2.0 * slope * mass)));
}

}  // namespace

std::vector<float> reconstructionTable(const FilmDescription& film) {
    const double radius = film.filterRadius;
    if (film.filter == ReconstructionFilter::Box && radius == 0.5) return {};

    // Trapezoids on half of the symmetric filter: with 2^16 of them the error is below 1e-9 radii.
    constexpr int kSteps = 65536;
    const double step = radius / kSteps;
    std::vector<double> weights(kSteps + 1), running(kSteps + 1, 0.0);
    for (int i = 0; i <= kSteps; ++i) weights[i] = filterWeight(film, i * step, radius);
    for (int i = 0; i < kSteps; ++i) running[i + 1] = running[i] + 0.5 * step * (weights[i] + weights[i + 1]);

    std::vector<float> table(257, 0.0f);
    for (int k = 1; k < 128; ++k) {
        const double mass = running.back() * k / 128.0;
        const auto above = std::upper_bound(running.begin(), running.end(), mass);
        const int i = std::min(int(above - running.begin()) - 1, kSteps - 1);
        const double x = i * step + invertLinear(weights[i], weights[i + 1], step, mass - running[i]);
        table[128 + k] = float(x);
        table[128 - k] = -float(x);
    }
    table.front() = -float(radius);
    table.back() = float(radius);
    return table;
}

}  // namespace parhelion
