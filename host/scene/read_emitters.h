#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads a scene-level <emitter> and appends it to the scene's emitters.
void readEmitter(ReadContext& context, const XmlElement& element);

/// Reads an <emitter type="area"> nested in a shape.
void readAreaEmitter(ReadContext& context, const XmlElement& element, ShapeDescription& shape);

}  // namespace parhelion
