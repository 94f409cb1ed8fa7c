#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads a scene-level <emitter> and appends it to the scene's emitters.
void readEmitter(ReadContext& context, const XmlElement& element);

/// Radiance of an <emitter type="area"> nested in a shape.
glm::dvec3 readAreaEmitter(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
