#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads a <mesh> with its surface, light and medium, and appends it to the scene's shapes.
void readNoriMesh(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
