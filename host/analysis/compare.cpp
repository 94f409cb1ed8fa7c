#include "analysis/compare.h"

#include <algorithm>
#include <bit>

#include "analysis/image_pair.h"
#include "analysis/tiles.h"

namespace parhelion {

namespace {

std::vector<ChannelPair> pairChannels(const Image& a, const Image& b, const ComparisonOptions& options) {
    requireComparable(a, a.size, options.names[0]);
    requireComparable(b, a.size, options.names[1]);
    std::vector<ChannelPair> pairs;
    for (const char* channel : kComparedChannels) pairs.emplace_back(a, b, channel);
    return pairs;
}

NoiseSource noiseOf(const std::vector<ChannelPair>& pairs) {
    const bool a = std::ranges::all_of(pairs, &ChannelPair::knowsNoiseOfA);
    const bool b = std::ranges::all_of(pairs, &ChannelPair::knowsNoiseOfB);
    if (a && b) return NoiseSource::both;
    if (a) return NoiseSource::imageA;
    return b ? NoiseSource::imageB : NoiseSource::none;
}

/// Calls visit(a, b) for every value that is finite in both images.
template <typename Visit>
void forEachFinite(const std::vector<ChannelPair>& pairs, const Visit& visit) {
    for (const ChannelPair& pair : pairs)
        for (std::size_t i = 0; i < pair.a().size(); ++i)
            if (pair.isFinite(i)) visit(double{pair.a()[i]}, double{pair.b()[i]});
}

double relativeMseEpsilon(const std::vector<ChannelPair>& pairs) {
    std::vector<double> values;
    double sum = 0;
    forEachFinite(pairs, [&](double, double b) {
        values.push_back(b);
        sum += std::abs(b);
    });
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    const double scale = *middle != 0 ? *middle : sum / static_cast<double>(values.size());
    return std::pow(0.01 * scale, 2);
}

void countValues(const std::vector<ChannelPair>& pairs, ImageComparison& result) {
    for (const ChannelPair& pair : pairs)
        for (std::size_t i = 0; i < pair.a().size(); ++i) {
            ++result.values;
            result.differing += std::bit_cast<std::uint32_t>(pair.a()[i]) != std::bit_cast<std::uint32_t>(pair.b()[i]);
            result.nonFinite += !pair.isFinite(i);
            result.nonFiniteA += !pair.isFiniteInA(i);
            result.nonFiniteB += !pair.isFiniteInB(i);
        }
}

void measureErrors(const std::vector<ChannelPair>& pairs, ImageComparison& result) {
    result.relativeMseEpsilon = relativeMseEpsilon(pairs);
    std::size_t count = 0;
    forEachFinite(pairs, [&](double a, double b) {
        const double difference = a - b;
        ++count;
        result.meanSquaredError += difference * difference;
        result.meanAbsoluteError += std::abs(difference);
        result.maxAbsoluteError = std::max(result.maxAbsoluteError, std::abs(difference));
        // Infinite against a black image; nothing against nothing is no error.
        if (difference != 0) result.relativeMse += difference * difference / (b * b + result.relativeMseEpsilon);
    });
    const double divisor = static_cast<double>(std::max<std::size_t>(count, 1));
    for (double* sum : {&result.meanSquaredError, &result.meanAbsoluteError, &result.relativeMse}) *sum /= divisor;
}

ChannelMeans meansOf(const ChannelPair& pair, glm::uvec2 size, const ComparisonOptions& options) {
    const MeanPair means = pair.means({.offset = {0, 0}, .size = size});
    ChannelMeans result;
    result.channel = pair.channel();
    result.meanA = means.a.value;
    result.meanB = means.b.value;
    const bool noisy = pair.knowsNoiseOfA() || pair.knowsNoiseOfB();
    if (noisy) result.z = differenceDeviate(means.a, means.b, options.rounding).normal();
    if (result.meanB == 0) return result;
    const RatioInterval interval = ratioOfMeans(means.a, means.b, options.confidence);
    result.ratio = interval.ratio;
    if (noisy) result.ratioConfidence = {interval.lower, interval.upper};
    return result;
}

LargestDeviation largestDeviation(const std::vector<ChannelPair>& pairs, const std::vector<PixelRect>& regions,
                                  const ComparisonOptions& options) {
    LargestDeviation largest{.tests = pairs.size() * regions.size(), .channel = {}};
    largest.threshold = twoSidedThreshold(sidak(options.significance, largest.tests));
    for (const ChannelPair& pair : pairs)
        for (const PixelRect& region : regions) {
            const MeanPair means = pair.means(region);
            largest.consider(differenceDeviate(means.a, means.b, options.rounding), pair.channel(), region.offset);
        }
    return largest;
}

}  // namespace

void LargestDeviation::consider(const StudentDeviate& deviate, const std::string& itsChannel, glm::uvec2 itsPixel) {
    // The normal deviate is never larger: most need no look at the distribution.
    if (std::abs(deviate.t) <= std::abs(z)) return;
    const double normal = deviate.normal();
    if (std::abs(normal) <= std::abs(z)) return;
    z = normal;
    channel = itsChannel;
    pixel = itsPixel;
}

ComparisonVerdict ImageComparison::verdict() const {
    if (differing == 0 || (nonFinite == 0 && maxAbsoluteError == 0)) return ComparisonVerdict::identical;
    if (nonFinite > 0) return ComparisonVerdict::notFinite;
    if (noise == NoiseSource::none) return ComparisonVerdict::noiseUnknown;
    if (!agree()) return ComparisonVerdict::differ;
    if (budget && budget->isMore()) return ComparisonVerdict::moreNoise;
    return budget && budget->isLess() ? ComparisonVerdict::lessNoise : ComparisonVerdict::agree;
}

bool ImageComparison::agree() const {
    if (nonFinite > 0) return false;
    if (!means || !tiles || !pixels) return maxAbsoluteError == 0;
    return means->passed() && tiles->passed() && pixels->passed();
}

bool ImageComparison::isNoiseAlone() const {
    return budget && !budget->isLess() ? nonFinite == 0 && !budget->isMore() : agree();
}

bool ImageComparison::hasIndependentNoise() const { return isNoiseAlone() && !(budget && budget->isLess()); }

ImageComparison compareImages(const Image& a, const Image& b, const ComparisonOptions& options) {
    const std::vector<ChannelPair> pairs = pairChannels(a, b, options);
    ImageComparison result;
    countValues(pairs, result);
    measureErrors(pairs, result);
    for (const ChannelPair& pair : pairs) result.channels.push_back(meansOf(pair, a.size, options));
    result.noise = noiseOf(pairs);
    if (result.noise == NoiseSource::none) return result;
    const unsigned whole = std::max(a.size.x, a.size.y);
    result.means = largestDeviation(pairs, tilesOf(a.size, whole), options);
    result.tiles = largestDeviation(pairs, tilesOf(a.size, kTileEdge), options);
    result.pixels = largestDeviation(pairs, tilesOf(a.size, 1), options);
    result.budget = noiseBudget(pairs, a.size, options.significance, options.confidence);
    return result;
}

Image errorImage(const Image& a, const Image& b, const ComparisonOptions& options) {
    const std::vector<ChannelPair> pairs = pairChannels(a, b, options);
    const bool noisy = noiseOf(pairs) != NoiseSource::none;
    const std::vector<PixelRect> pixels = tilesOf(a.size, 1);
    Image image{.size = a.size, .channels = {}, .attributes = {}};
    for (const ChannelPair& pair : pairs) {
        std::vector<float>& errors = image.channels["error." + pair.channel()];
        for (std::size_t i = 0; i < pixels.size(); ++i) errors.push_back(pair.a()[i] - pair.b()[i]);
        if (!noisy) continue;
        std::vector<float>& deviates = image.channels["z." + pair.channel()];
        for (const PixelRect& pixel : pixels) {
            const MeanPair means = pair.means(pixel);
            deviates.push_back(static_cast<float>(differenceDeviate(means.a, means.b, options.rounding).normal()));
        }
    }
    return image;
}

}  // namespace parhelion
