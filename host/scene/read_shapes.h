#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads a <shape> with its BSDF, media, emitter and mesh file, and appends it to the scene's shapes.
void readShape(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
