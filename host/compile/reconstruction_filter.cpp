#include <algorithm>
#include <cmath>
#include <span>

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

/// The share u that the inverse CDF, linear between its steps, maps to at most x.
float shareBelow(std::span<const float> table, float x) {
    const auto steps = table.first(shared::kFilterSteps + 1);
    const auto above = std::upper_bound(steps.begin(), steps.end() - 1, x);
    const auto i = above - steps.begin() - 1;
    return float((double(i) + (double(x) - steps[i]) / (double(steps[i + 1]) - steps[i])) / shared::kFilterSteps);
}

}  // namespace

std::vector<float> reconstructionTable(const FilmDescription& film) {
    const double radius = film.filterRadius;
    if (film.filter == ReconstructionFilter::Box && radius == 0.5) return {};

    // Trapezoids on half of the symmetric filter: with 2^16 of them the error is below 1e-9 radii.
    constexpr int kSteps = 65536, kHalf = shared::kFilterSteps / 2;
    const double step = radius / kSteps;
    std::vector<double> weights(kSteps + 1), running(kSteps + 1, 0.0);
    for (int i = 0; i <= kSteps; ++i) weights[i] = filterWeight(film, i * step, radius);
    for (int i = 0; i < kSteps; ++i) running[i + 1] = running[i] + 0.5 * step * (weights[i] + weights[i + 1]);

    std::vector<float> table(shared::kFilterSteps + 1, 0.0f);
    for (int k = 1; k < kHalf; ++k) {
        const double mass = running.back() * k / kHalf;
        const auto above = std::upper_bound(running.begin(), running.end(), mass);
        const int i = std::min(int(above - running.begin()) - 1, kSteps - 1);
        const double x = i * step + invertLinear(weights[i], weights[i + 1], step, mass - running[i]);
        table[kHalf + k] = float(x);
        table[kHalf - k] = -float(x);
    }
    table.front() = -float(radius);
    table.back() = float(radius);
    if (!film.samplesBorder)
        for (double edge = 0.5; edge < radius; edge += 1.0) table.push_back(shareBelow(table, float(edge)));
    return table;
}

}  // namespace parhelion
