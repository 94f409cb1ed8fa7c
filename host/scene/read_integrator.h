#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads <integrator>, through a "moment" around it: fills the scene's integrator.
void readIntegrator(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
