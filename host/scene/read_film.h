#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads <film> with its <rfilter>: fills the scene's film.
void readFilm(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
