#pragma once

#include <random>
#include <string>

#include "image/image.h"

namespace parhelion::test {

inline constexpr const char* kChannels[] = {"R", "G", "B"};

inline Image constantImage(glm::uvec2 size, float value) {
    Image image{.size = size, .channels = {}, .attributes = {}};
    for (const char* channel : kChannels) image.channels[channel].assign(std::size_t{size.x} * size.y, value);
    return image;
}

/// Pixels of mean (0.5, 1, 2), each with a normal error of the standard deviation that its variance layer states.
inline Image noisyImage(glm::uvec2 size, double relativeDeviation, unsigned seed) {
    Image image{.size = size, .channels = {}, .attributes = {}};
    std::mt19937 random(seed);
    for (int c = 0; c < 3; ++c) {
        const double mean = 0.5 * (1 << c), deviation = relativeDeviation * mean;
        std::normal_distribution<double> value(mean, deviation);
        for (unsigned i = 0; i < size.x * size.y; ++i) {
            image.channels[kChannels[c]].push_back(static_cast<float>(value(random)));
            image.channels[std::string("variance.") + kChannels[c]].push_back(float(deviation * deviation));
        }
    }
    return image;
}

inline void scale(Image& image, double factor) {
    for (const char* channel : kChannels)
        for (float& value : image.channels[channel]) value = static_cast<float>(value * factor);
}

inline void setVariances(Image& image, float variance) {
    for (const char* channel : kChannels)
        image.channels[std::string("variance.") + channel].assign(std::size_t{image.size.x} * image.size.y, variance);
}

inline void removeVariances(Image& image) {
    for (const char* channel : kChannels) image.channels.erase(std::string("variance.") + channel);
}

}  // namespace parhelion::test
