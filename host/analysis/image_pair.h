#pragma once

#include <array>
#include <span>
#include <string>

#include "analysis/statistics.h"
#include "base/film.h"
#include "image/image.h"

namespace parhelion {

inline constexpr std::array<const char*, 3> kComparedChannels{"R", "G", "B"};

/// @param name  what the message calls the image.
/// @throws InputError unless the image has the size and the channels R, G and B, and variances of all three or none,
/// none
///         of them negative.
void requireComparable(const Image& image, glm::uvec2 size, const std::string& name);

/// Means over the same pixels of two images.
struct MeanPair {
    NoisyMean a;
    NoisyMean b;
};

/// One channel of two images of one size, with their noise where known. Refers to the images: they must outlive it.
class ChannelPair {
public:
    ChannelPair(const Image& a, const Image& b, const std::string& channel);

    const std::string& channel() const { return channel_; }
    std::span<const float> a() const { return sideA_.values; }
    std::span<const float> b() const { return sideB_.values; }
    bool knowsNoiseOfA() const { return !sideA_.variances.empty(); }
    bool knowsNoiseOfB() const { return !sideB_.variances.empty(); }

    /// Both values, and the variances there are, are finite.
    bool isFinite(std::size_t pixel) const { return isFiniteInA(pixel) && isFiniteInB(pixel); }
    bool isFiniteInA(std::size_t pixel) const { return sideA_.isFinite(pixel); }
    bool isFiniteInB(std::size_t pixel) const { return sideB_.isFinite(pixel); }

    /// Means over a rectangle, of the pixels that are finite in both; pixels count as independent.
    MeanPair means(const PixelRect& rect) const;

private:
    struct Side {
        std::span<const float> values;
        std::span<const float> variances;     ///< of each pixel's mean; empty: unknown
        std::span<const float> sampleCounts;  ///< empty: unknown
        double degreesOfFreedom;              ///< of the variances where the sample counts are unknown

        Side(const Image& image, const std::string& channel);
        bool isFinite(std::size_t pixel) const;
        void addTo(NoisyMean& mean, std::size_t pixel, double weight) const;
    };

    std::string channel_;
    Side sideA_;
    Side sideB_;
    unsigned width_ = 0;
};

}  // namespace parhelion
