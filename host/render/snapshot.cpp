#include "render/snapshot.h"

#include <algorithm>

namespace parhelion::render {

void Snapshot::keep(std::span<const shared::FilmPixel> film, std::span<const shared::LayerPixel> layersOfBatch,
                    std::size_t from, std::size_t to) {
    if (pixels.size() <= to) pixels.resize(to + 1);
    pixels[to] = film[from];
    const std::size_t count = layersOfBatch.size() / film.size();
    if (layers.size() < (to + 1) * count) layers.resize((to + 1) * count);
    std::ranges::copy(layersOfBatch.subspan(from * count, count), layers.begin() + std::ptrdiff_t(to * count));
}

}  // namespace parhelion::render
