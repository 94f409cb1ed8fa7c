#include "analysis/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "analysis/image_pair.h"
#include "analysis/rms_bias.h"
#include "analysis/tiles.h"

namespace parhelion {

namespace {

/// One channel of all images of one side.
class Side {
public:
    Side(std::span<const Image> images, const std::string& channel, bool independentPixels)
        : width_(images[0].size.x), freedom_(static_cast<double>(images.size()) - 1) {
        std::vector<std::span<const float>> values;
        for (const Image& image : images) values.push_back(image.channels.at(channel));
        if (!independentPixels) {
            values_ = std::move(values);
            return;
        }
        for (std::size_t i = 0; i < values[0].size(); ++i) {
            RunningMoments moments;
            for (const auto& image : values) moments.add(image[i]);
            means_.push_back(moments.mean());
            variances_.push_back(moments.variance() / static_cast<double>(images.size()));
        }
    }

    /// @param reference  with the channel's variance.
    Side(const Image& reference, std::size_t seeds, const std::string& channel)
        : width_(reference.size.x), freedom_(static_cast<double>(seeds) - 1) {
        const auto& means = reference.channels.at(channel);
        const auto& variances = reference.channels.at("variance." + channel);
        means_.assign(means.begin(), means.end());
        variances_.assign(variances.begin(), variances.end());
    }

    /// Mean over a rectangle and over the images; noise from the spread between the images.
    NoisyMean mean(const PixelRect& rect) const { return values_.empty() ? pooledMean(rect) : plainMean(rect); }

private:
    NoisyMean plainMean(const PixelRect& rect) const {
        RunningMoments moments;
        const double weight = 1.0 / (double(rect.size.x) * rect.size.y);
        for (const auto& values : values_) {
            double sum = 0;
            forEachPixel(rect, width_, [&](std::size_t i) { sum += values[i]; });
            moments.add(weight * sum);
        }
        NoisyMean result{moments.mean(), {}};
        result.noise.add(moments.variance() / static_cast<double>(moments.count()), freedom_);
        return result;
    }

    NoisyMean pooledMean(const PixelRect& rect) const {
        NoisyMean result;
        const double weight = 1.0 / (double(rect.size.x) * rect.size.y);
        forEachPixel(rect, width_, [&](std::size_t i) {
            result.value += weight * means_[i];
            result.noise.add(weight * weight * variances_[i], freedom_);
        });
        return result;
    }

    std::vector<std::span<const float>> values_;  ///< of each image, when whole images are compared
    std::vector<double> means_, variances_;       ///< of each pixel and of its mean, when pixels are
    unsigned width_ = 0;
    double freedom_ = 0;  ///< of each variance
};

/// One channel of both sides.
struct SidePair {
    std::string channel;
    Side a;
    Side b;
};

void requireSeeds(std::span<const Image> images, glm::uvec2 size, const std::string& side) {
    if (images.size() < 2)
        throw InputError(
            fmt::format("testing agreement needs 2 images a side or more; the {} side has {}", side, images.size()));
    for (std::size_t k = 0; k < images.size(); ++k)
        requireComparable(images[k], size, fmt::format("image {} of the {} side", k + 1, side));
}

void requireReference(const Image& reference, std::size_t seeds, glm::uvec2 size) {
    if (seeds < 2)
        throw InputError(fmt::format("testing agreement needs a reference of 2 images or more; got {}", seeds));
    requireComparable(reference, size, "the reference");
    for (const char* channel : kComparedChannels)
        if (!reference.has(std::string("variance.") + channel))
            throw InputError(fmt::format("the reference has no channel variance.{}: its noise is not known", channel));
}

std::size_t countNonFinite(std::span<const Image> images) {
    std::size_t count = 0;
    for (const Image& image : images)
        for (const char* channel : kComparedChannels)
            count += static_cast<std::size_t>(
                std::ranges::count_if(image.channels.at(channel), [](float x) { return !std::isfinite(x); }));
    return count;
}

/// Images of the first side that are also among those of the second.
std::size_t countShared(std::span<const Image> a, std::span<const Image> b) {
    const auto isSame = [](const Image& one, const Image& other) {
        return std::ranges::all_of(kComparedChannels, [&](const char* channel) {
            return one.channels.at(channel) == other.channels.at(channel);
        });
    };
    return static_cast<std::size_t>(std::ranges::count_if(a, [&](const Image& one) {
        return std::ranges::any_of(b, [&](const Image& other) { return isSame(one, other); });
    }));
}

double median(std::vector<double>& values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Relative noise and its degrees of freedom, region by region.
struct Sharpness {
    std::vector<double> relativeNoise;
    std::vector<double> degreesOfFreedom;

    void add(const NoisyMean& a, const NoisyMean& b) {
        PooledVariance noise = a.noise;
        noise.add(b.noise);
        if (b.value == 0 || noise.variance() == 0) return;
        relativeNoise.push_back(noise.deviation() / std::abs(b.value));
        degreesOfFreedom.push_back(noise.degreesOfFreedom());
    }

    /// Relative bias that a test with this limit for normal deviates finds in the region of median noise.
    double smallestBias(double threshold, double power) {
        const double freedom = median(degreesOfFreedom);
        if (freedom == 0) return 0;
        const double limit = freedom < 1e6 ? studentLimit(threshold, freedom) : threshold;
        return detectableDeviation(limit, power) * median(relativeNoise);
    }

    /// The t that is as improbable as the normal deviate.
    static double studentLimit(double threshold, double degreesOfFreedom) {
        return -studentQuantile(std::erfc(threshold / std::sqrt(2.0)) / 2, degreesOfFreedom);
    }
};

ScaleAgreement compareRegions(const std::vector<SidePair>& pairs, const std::vector<PixelRect>& regions,
                              const AgreementOptions& options) {
    ScaleAgreement result;
    LargestDeviation& largest = result.largest;
    largest.tests = pairs.size() * regions.size();
    largest.threshold = twoSidedThreshold(sidak(options.significance, largest.tests));
    Sharpness sharpness;
    for (const SidePair& pair : pairs)
        for (const PixelRect& region : regions) {
            const NoisyMean a = pair.a.mean(region), b = pair.b.mean(region);
            sharpness.add(a, b);
            largest.consider(differenceDeviate(a, b, options.rounding), pair.channel, region.offset);
        }
    result.smallestBias = sharpness.smallestBias(largest.threshold, options.power);
    return result;
}

ChannelAgreement agreementOfMeans(const SidePair& pair, glm::uvec2 size, const AgreementOptions& options) {
    const PixelRect whole{.offset = {0, 0}, .size = size};
    const NoisyMean a = pair.a.mean(whole), b = pair.b.mean(whole);
    ChannelAgreement result;
    result.channel = pair.channel;
    result.meanA = a.value;
    result.meanB = b.value;
    if (b.value == 0) return result;
    result.ratio = ratioOfMeans(a, b, options.confidence);
    const RatioInterval certain = ratioOfMeans(a, b, 1 - 2 * options.significance);
    result.equivalence = std::max(std::abs(certain.lower - 1), std::abs(certain.upper - 1));
    return result;
}

std::string describeChannel(const ChannelAgreement& channel) {
    std::string text = fmt::format("mean {}: {:.8g} against {:.8g}", channel.channel, channel.meanA, channel.meanB);
    const auto out = std::back_inserter(text);
    if (const auto& ratio = channel.ratio)
        fmt::format_to(out, ", ratio {:.6f} [{:.6f}, {:.6f}], proven within {:.3g} %", ratio->ratio, ratio->lower,
                       ratio->upper, 100 * *channel.equivalence);
    if (const auto& bias = channel.rmsBias)
        fmt::format_to(out, ", RMS bias of a pixel {:.3g} [{:.3g}, {:.3g}]", bias->estimate, bias->lower, bias->upper);
    return text + "\n";
}

std::string describeScale(const char* name, const ScaleAgreement& scale) {
    return fmt::format("{}: {}; would have found a bias of {:.3g} %\n", name, describe(scale.largest),
                       100 * scale.smallestBias);
}

void compareScales(ImageAgreement& result, const std::vector<SidePair>& pairs, glm::uvec2 size,
                   const AgreementOptions& options) {
    for (const SidePair& pair : pairs) result.channels.push_back(agreementOfMeans(pair, size, options));
    result.means = compareRegions(pairs, tilesOf(size, std::max(size.x, size.y)), options);
    result.tiles = compareRegions(pairs, tilesOf(size, kTileEdge), options);
    result.pixels = compareRegions(pairs, tilesOf(size, 1), options);
}

}  // namespace

bool ImageAgreement::agree() const {
    return nonFinite == 0 && means.largest.passed() && tiles.largest.passed() && pixels.largest.passed();
}

ImageAgreement testAgreement(std::span<const Image> a, std::span<const Image> b, const AgreementOptions& options) {
    const glm::uvec2 size = a.empty() ? glm::uvec2(0) : a[0].size;
    requireSeeds(a, size, "first");
    requireSeeds(b, size, "second");
    ImageAgreement result;
    result.seedsA = a.size();
    result.seedsB = b.size();
    result.nonFinite = countNonFinite(a) + countNonFinite(b);
    if (result.nonFinite > 0) return result;  // any mean they enter would say nothing
    result.shared = countShared(a, b);
    std::vector<SidePair> pairs;
    for (const char* channel : kComparedChannels)
        pairs.push_back(
            {channel, Side(a, channel, options.independentPixels), Side(b, channel, options.independentPixels)});
    compareScales(result, pairs, size, options);
    for (ChannelAgreement& channel : result.channels)
        channel.rmsBias = rmsBias(a, b, channel.channel, options.confidence);
    return result;
}

ImageAgreement testAgreement(std::span<const Image> a, const Image& reference, std::size_t seeds,
                             const AgreementOptions& options) {
    requireSeeds(a, reference.size, "first");
    requireReference(reference, seeds, reference.size);
    ImageAgreement result;
    result.seedsA = a.size();
    result.seedsB = seeds;
    result.nonFinite = countNonFinite(a) + countNonFinite({&reference, 1});
    if (result.nonFinite > 0) return result;
    std::vector<SidePair> pairs;
    for (const char* channel : kComparedChannels)
        pairs.push_back({channel, Side(a, channel, options.independentPixels), Side(reference, seeds, channel)});
    compareScales(result, pairs, reference.size, options);
    return result;
}

std::string describe(const ImageAgreement& agreement) {
    std::string text = fmt::format("{} and {} images\n", agreement.seedsA, agreement.seedsB);
    if (agreement.shared > 0)
        text += fmt::format("identical on both sides: {} images, without noise or not independent\n", agreement.shared);
    if (agreement.nonFinite > 0) return text + fmt::format("values not finite: {}: DIFFERS\n", agreement.nonFinite);
    for (const ChannelAgreement& channel : agreement.channels) text += describeChannel(channel);
    return text + describeScale("image means", agreement.means) + describeScale("8 x 8 tiles", agreement.tiles) +
           describeScale("pixels", agreement.pixels);
}

}  // namespace parhelion
