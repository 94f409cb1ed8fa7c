#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads the <medium> inside a mesh, appends it to the scene's media and returns its index.
std::size_t readNoriMedium(ReadContext& context, const XmlElement& element);

/// Reads a <medium> of its own: it fills its bounds, which become a shape.
void readNoriMediumInItsBounds(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
