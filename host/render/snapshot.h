#pragma once

#include <span>
#include <vector>

#include "base/film.h"

namespace parhelion::render {

/// A film at a moment when every pixel had the same samples: what is left of a render that is stopped.
struct Snapshot {
    std::uint64_t samples = 0;  ///< of every pixel; 0: none yet
    std::vector<shared::FilmPixel> pixels;
    std::vector<shared::LayerPixel> layers;

    /// Copies a pixel with its layers.
    /// @param film, layers  of the batch; layers may be empty
    /// @param from  index in the batch
    /// @param to  index in the whole film, which the snapshot grows to
    void keep(std::span<const shared::FilmPixel> film, std::span<const shared::LayerPixel> layersOfBatch,
              std::size_t from, std::size_t to);
};

}  // namespace parhelion::render
