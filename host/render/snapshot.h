#pragma once

#include <span>
#include <vector>

#include "base/film.h"
#include "render/path_trace_pass.h"

namespace parhelion::render {

/// A film at a moment when every pixel had the same samples: what is left of a render that is stopped.
struct Snapshot {
    std::uint64_t samples = 0;  ///< of every pixel; 0: none yet
    std::vector<shared::FilmPixel> pixels;
    std::vector<std::array<shared::FilmPixel, shared::kControlRuns>> controls;
    std::vector<shared::LayerPixel> layers;

    /// Copies a pixel with its layers, or a run of a control pixel.
    /// @param film, layersOfBatch  of the batch; layers may be empty
    /// @param from  index in them: see PathTracePass::film
    void keep(const Batch& batch, std::span<const shared::FilmPixel> film,
              std::span<const shared::LayerPixel> layersOfBatch, std::size_t from);
    /// Gives the film what is kept. The control pixels are named there.
    void moveTo(Film& film);
};

}  // namespace parhelion::render
