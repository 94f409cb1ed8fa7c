#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads a <phase>.
PhaseDescription readPhase(const ReadContext& context, const XmlElement& element);

}  // namespace parhelion
