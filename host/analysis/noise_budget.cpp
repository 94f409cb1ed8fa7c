#include "analysis/noise_budget.h"

#include <algorithm>
#include <cmath>

#include "analysis/tiles.h"

namespace parhelion {

std::optional<NoiseBudget> noiseBudget(std::span<const ChannelPair> pairs, glm::uvec2 size, double significance,
                                       double confidence) {
    RunningMoments squaredErrors, excess, variances;
    for (const PixelRect& pixel : tilesOf(size, 1)) {
        const std::size_t index = std::size_t{pixel.offset.y} * size.x + pixel.offset.x;
        if (!std::ranges::all_of(pairs, [&](const ChannelPair& pair) { return pair.isFinite(index); })) continue;
        double squares = 0, variance = 0;
        for (const ChannelPair& pair : pairs) {
            const MeanPair means = pair.means(pixel);
            squares += std::pow(means.a.value - means.b.value, 2) / double(pairs.size());
            variance += (means.a.noise.variance() + means.b.noise.variance()) / double(pairs.size());
        }
        squaredErrors.add(squares);
        excess.add(squares - variance);
        variances.add(variance);
    }
    if (excess.count() < 2 || !(variances.mean() > 0)) return std::nullopt;
    const double error = excess.standardError(), unit = variances.mean();
    const double reach = normalQuantile((1 + confidence) / 2) * error;
    NoiseBudget budget{.expected = unit, .ratio = 1 + excess.mean() / unit};
    budget.ratioConfidence = {std::max(0.0, budget.ratio - reach / unit), budget.ratio + reach / unit};
    budget.z = zTest(excess.mean(), 0, error).z;
    budget.threshold = twoSidedThreshold(significance);
    // The squared bias is at most the squared error. Noise that is known to be independent may be taken off it; a bound
    // of what is left starts at 0, the least that a square can be.
    const double square = budget.isLess() ? squaredErrors.mean() : std::max(0.0, excess.mean());
    const double uncertainty = budget.isLess() ? squaredErrors.standardError() : error;
    budget.largestBias = std::sqrt(square + normalQuantile(confidence) * uncertainty);
    return budget;
}

}  // namespace parhelion
