#include "analysis/rms_bias.h"

#include <algorithm>
#include <cmath>

namespace parhelion {

namespace {

double signedRoot(double square) { return std::copysign(std::sqrt(std::abs(square)), square); }

/// Squared bias from all pairs of different seeds, and the same without each seed in turn.
struct SquaredBias {
    double all = 0;
    std::vector<double> without;
};

/// With s = sum and q = sum of squares of the differences, sum over k != l of d_k d_l = s^2 - q.
SquaredBias squaredBias(std::span<const Image> a, std::span<const Image> b, const std::string& channel) {
    const std::size_t pairs = std::min(a.size(), b.size());
    const std::size_t pixels = a[0].channels.at(channel).size();
    std::vector<double> differences(pairs);
    SquaredBias result{0, std::vector<double>(pairs, 0.0)};
    for (std::size_t i = 0; i < pixels; ++i) {
        double sum = 0, squares = 0;
        for (std::size_t k = 0; k < pairs; ++k) {
            differences[k] = double{a[k].channels.at(channel)[i]} - double{b[k].channels.at(channel)[i]};
            sum += differences[k];
            squares += differences[k] * differences[k];
        }
        result.all += sum * sum - squares;
        for (std::size_t k = 0; k < pairs; ++k) {
            const double rest = sum - differences[k];
            result.without[k] += rest * rest - (squares - differences[k] * differences[k]);
        }
    }
    const double n = static_cast<double>(pairs), count = static_cast<double>(pixels);
    result.all /= count * n * (n - 1);
    for (double& value : result.without) value /= count * (n - 1) * (n - 2);
    return result;
}

}  // namespace

std::optional<RmsBias> rmsBias(std::span<const Image> a, std::span<const Image> b, const std::string& channel,
                               double confidence) {
    if (std::min(a.size(), b.size()) < 3) return std::nullopt;
    const SquaredBias square = squaredBias(a, b, channel);
    RunningMoments moments;
    for (const double value : square.without) moments.add(value);
    const double n = static_cast<double>(moments.count());
    const double deviation = std::sqrt((n - 1) * (n - 1) / n * moments.variance());
    const double reach = studentQuantile((1 + confidence) / 2, n - 1) * deviation;
    return RmsBias{signedRoot(square.all), signedRoot(square.all - reach), signedRoot(square.all + reach)};
}

}  // namespace parhelion
