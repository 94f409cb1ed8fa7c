#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Index of a <medium> in the scene's media; read at the first call for it.
std::size_t mediumIndex(ReadContext& context, const XmlElement& element);

/// Reads a <medium> without adding it to the scene.
MediumDescription readMedium(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
