#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads the <integrator>: direct (with its strategy), path_mis or path_mis_vol.
void readNoriIntegrator(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
