#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads an <emitter> that belongs to no mesh and appends it to the scene's emitters.
void readNoriEmitter(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
