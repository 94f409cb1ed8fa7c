#pragma once

#include "scene/read_context.h"

namespace parhelion {

inline constexpr std::int64_t kLargestFilm = 32768;  ///< pixels on a side
inline constexpr NumberRange kFilterWidth{0.0, 32.0, true, false, "be in (0, 32] pixels"};

/// Reads <film> with its <rfilter>: fills the scene's film.
void readFilm(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
