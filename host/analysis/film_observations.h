#pragma once

#include <vector>

#include "analysis/pixel_trust.h"
#include "analysis/variance_factors.h"

namespace parhelion {

/// A pixel of the image, or one that stands for several.
struct Observation {
    const shared::FilmPixel* pixel = nullptr;
    std::uint64_t samples = 0;
    double factor = 1;   ///< VarianceFactors::near
    double weight = 1;   ///< pixels that it stands for
    glm::uvec2 cell{0};  ///< of pixels near it
};

/// Observations of an image and how they lie.
struct Observations {
    std::vector<Observation> all;
    glm::uvec2 grid{1};        ///< cells
    std::uint32_t radius = 1;  ///< of a neighbourhood, cells

    JudgedPixel judged(std::size_t i) const {
        return {momentsOf(*all[i].pixel, all[i].samples), all[i].factor, all[i].cell};
    }
};

/// Every pixel of the image.
Observations observeImage(const Film& film, const VarianceFactors& factors);

/// Every run of the control pixels, which together stand for the image.
Observations observeControls(const Film& film, const VarianceFactors& factors);

}  // namespace parhelion
