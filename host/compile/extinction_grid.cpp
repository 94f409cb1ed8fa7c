#include "compile/extinction_grid.h"

#include <algorithm>

namespace parhelion {

ExtinctionGrid::ExtinctionGrid(const Volume& volume) : volume_(&volume) {
    if (volume.channels != 3) return;
    const std::vector<float>& values = volume.color.values;
    std::vector<float> largest(values.size() / 3);
    for (std::size_t i = 0; i < largest.size(); ++i) {
        const float r = values[3 * i], g = values[3 * i + 1], b = values[3 * i + 2];
        largest[i] = std::max({r, g, b});
        isColored_ = isColored_ || r != g || g != b;
    }
    folded_ = DensityGrid::fromDense(volume.color.resolution, largest);
}

float largestValue(const Volume& volume) {
    if (volume.channels == 1) return volume.density.maximum();
    const std::vector<float>& values = volume.color.values;
    return values.empty() ? 0.0f : *std::ranges::max_element(values);
}

}  // namespace parhelion
