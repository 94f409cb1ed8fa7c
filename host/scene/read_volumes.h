#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// What a <volume> stands for, which decides the values it may hold.
enum class VolumeRole { Extinction, Albedo };

/// A <volume>: a grid, or a constant (which is 1 when there is a grid).
struct ReadVolume {
    glm::dvec3 constant{1.0};
    VolumeExtent extent;  ///< of the constant
    std::optional<GridPlacement> grid;
};

/// Reads <volume type="constvolume">, "gridvolume", with the file a grid names, or "procedural_cloud" (extinction).
/// @throws InputError also for three-channel extinction and for albedos outside [0, 1].
ReadVolume readVolumePlugin(ReadContext& context, const XmlElement& element, VolumeRole role);

}  // namespace parhelion
