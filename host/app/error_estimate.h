#pragma once

#include <optional>

#include "base/film.h"

namespace parhelion::app {

/// The image's noise relative to its brightness: sqrt(mean variance of the pixel means) / mean pixel, over all
/// pixels and channels. Estimated from the film's own samples, so it misses what they have not yet met (fireflies).
/// Nothing before each pixel has two samples, for a black image, and where a sum left the range of float.
std::optional<double> estimateRelativeError(const Film& film);

}  // namespace parhelion::app
