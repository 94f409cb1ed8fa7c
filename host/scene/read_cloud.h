#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads <volume type="procedural_cloud">, with the density that it modulates if one is nested. Not baked yet.
GridPlacement readProceduralCloud(ReadContext& context, PropertyReader& reader);

}  // namespace parhelion
