#include "render/snapshot.h"

#include <algorithm>

namespace parhelion::render {

void Snapshot::keep(const Batch& batch, std::span<const shared::FilmPixel> film,
                    std::span<const shared::LayerPixel> layersOfBatch, std::size_t from) {
    if (from >= batch.pixelCount) {
        const std::size_t run = from - batch.pixelCount, control = batch.firstControl + run / shared::kControlRuns;
        if (controls.size() <= control) controls.resize(control + 1);
        controls[control][run % shared::kControlRuns] = film[from];
        return;
    }
    const std::size_t to = batch.firstPixel + from;
    if (pixels.size() <= to) pixels.resize(to + 1);
    pixels[to] = film[from];
    const std::size_t count = layersOfBatch.size() / film.size();
    if (layers.size() < (to + 1) * count) layers.resize((to + 1) * count);
    std::ranges::copy(layersOfBatch.subspan(from * count, count), layers.begin() + std::ptrdiff_t(to * count));
}

void Snapshot::moveTo(Film& film) {
    film.pixels = std::move(pixels);
    film.layers = std::move(layers);
    for (std::size_t i = 0; i < controls.size(); ++i) film.controls[i].runs = controls[i];
}

}  // namespace parhelion::render
