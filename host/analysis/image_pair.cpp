#include "analysis/image_pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/tiles.h"

namespace parhelion {

namespace {

std::span<const float> channelOrNothing(const Image& image, const std::string& name) {
    const auto found = image.channels.find(name);
    return found == image.channels.end() ? std::span<const float>{} : std::span<const float>(found->second);
}

/// The variances of an image made of several count as estimated from these; all others as exact.
double degreesOfFreedomOf(const Image& image) {
    const auto found = image.attributes.find("seeds");
    if (found == image.attributes.end() || !std::holds_alternative<std::int64_t>(found->second))
        return std::numeric_limits<double>::infinity();
    return std::max<double>(1, static_cast<double>(std::get<std::int64_t>(found->second)) - 1);
}

/// A test needs the noise of every channel, and no noise is negative.
void requireVariances(const Image& image, const std::string& name) {
    const auto nameOf = [](const char* channel) { return std::string("variance.") + channel; };
    const auto given = std::ranges::find_if(kComparedChannels, [&](auto* c) { return image.has(nameOf(c)); });
    if (given == kComparedChannels.end()) return;
    for (const char* channel : kComparedChannels) {
        if (!image.has(nameOf(channel)))
            throw InputError(fmt::format("{} has a channel '{}' and no '{}': the variances of R, G and B go together",
                                         name, nameOf(*given), nameOf(channel)));
        const std::vector<float>& variances = image.channels.at(nameOf(channel));
        const auto negative = std::ranges::find_if(variances, [](float x) { return x < 0; });
        if (negative == variances.end()) continue;
        const auto index = static_cast<std::size_t>(negative - variances.begin());
        throw InputError(fmt::format("{}: '{}' must be >= 0; got {} at pixel ({}, {})", name, nameOf(channel),
                                     *negative, index % image.size.x, index / image.size.x));
    }
}

}  // namespace

void requireComparable(const Image& image, glm::uvec2 size, const std::string& name) {
    if (image.size != size)
        throw InputError(fmt::format("images to compare must have one size, {} x {}; {} is {} x {}", size.x, size.y,
                                     name, image.size.x, image.size.y));
    for (const char* channel : kComparedChannels)
        if (!image.has(channel))
            throw InputError(
                fmt::format("images to compare must have channels R, G and B; {} has no '{}'", name, channel));
    requireVariances(image, name);
}

ChannelPair::Side::Side(const Image& image, const std::string& channel)
    : values(image.channels.at(channel)),
      variances(channelOrNothing(image, "variance." + channel)),
      sampleCounts(channelOrNothing(image, "sampleCount.Y")),
      degreesOfFreedom(degreesOfFreedomOf(image)) {}

bool ChannelPair::Side::isFinite(std::size_t pixel) const {
    return std::isfinite(values[pixel]) && (variances.empty() || std::isfinite(variances[pixel]));
}

void ChannelPair::Side::addTo(NoisyMean& mean, std::size_t pixel, double weight) const {
    mean.value += weight * values[pixel];
    if (variances.empty()) return;
    const double ofPixel = sampleCounts.empty() ? degreesOfFreedom : std::max(1.0, double{sampleCounts[pixel]} - 1);
    mean.noise.add(weight * weight * variances[pixel], ofPixel);
}

ChannelPair::ChannelPair(const Image& a, const Image& b, const std::string& channel)
    : channel_(channel), sideA_(a, channel), sideB_(b, channel), width_(a.size.x) {}

MeanPair ChannelPair::means(const PixelRect& rect) const {
    std::size_t count = 0;
    forEachPixel(rect, width_, [&](std::size_t i) { count += isFinite(i); });
    const double weight = 1.0 / static_cast<double>(std::max<std::size_t>(count, 1));
    MeanPair result;
    forEachPixel(rect, width_, [&](std::size_t i) {
        if (!isFinite(i)) return;
        sideA_.addTo(result.a, i, weight);
        sideB_.addTo(result.b, i, weight);
    });
    return result;
}

}  // namespace parhelion
