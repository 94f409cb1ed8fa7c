#pragma once

#include <cstdint>
#include <functional>

#include "base/film.h"

namespace parhelion::test {

/// A film without a renderer: every sample of a pixel is `sample(u)` of a random number u in [0, 1), so that the truth
/// is known. With control pixels, one of each tile of 4 x 4 pixels.
struct SampledScene {
    glm::uvec2 size{24, 16};
    std::function<double(double u)> sample;
    bool stratified = false;  ///< the u of a pixel are a randomised van der Corput sequence
};

/// A film that grows; films of different seeds are independent.
class SampledFilm {
public:
    SampledFilm(const SampledScene& scene, std::uint64_t seed);
    /// Takes samples until each pixel has as many.
    const Film& growTo(std::uint64_t samples);
    const Film& film() const { return film_; }

private:
    void addTo(shared::FilmPixel& pixel, std::uint64_t stream);

    SampledScene scene_;
    std::uint64_t seed_;
    Film film_;
};

}  // namespace parhelion::test
