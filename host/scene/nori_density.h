#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Unit cube -> world: the box from `boundsMin` to `boundsMax` in the medium's own space, then `toWorld`.
///
/// @param fallback  the box where the medium gives none; without one it must.
glm::dmat4 readNoriBounds(PropertyReader& reader, const std::optional<std::pair<glm::dvec3, glm::dvec3>>& fallback);

/// Reads a heterogeneous medium's density: a volume file, a procedural cloud, or a file that the cloud's detail erodes.
///
/// @param sigmaT  extinction at density 1; multiplied by a file's `densityScale`.
GridPlacement readNoriDensity(ReadContext& context, PropertyReader& reader, glm::dvec3& sigmaT);

}  // namespace parhelion
